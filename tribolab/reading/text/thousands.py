"""Thousands separators of numbers: 1.234,5 or "1,234.5" or 1 234,5."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence
from typing import Literal

Mark = Literal["", ".", ",", "'", " ", "\u00a0", "\u202f"]
_MARKS: tuple[Mark, ...] = (".", ",", "'", " ", "\u00a0", "\u202f")
_ROWS = 4000  # most lines inspected
_NUMBER = re.compile(r"\s*[+-]?\d[\d.,]*\s*")
_APART = "\t;"  # delimiters that are unambiguous with any separator
_BLANK = r"[^\S\t\n]"  # within a cell, so that a search passes a row of empty cells only once
# patterns of numbers with both marks, and of integers with separators only
_BOTH = re.compile(rf"\d[{''.join(_MARKS)}]\d{{3}}[.,]\d")
_WHOLE = re.compile(
    rf"(?m)(?:^|[\t;])(?:{_BLANK}|[+-])*[1-9]\d{{0,2}}(?:[.,]\d{{3}})+{_BLANK}*(?:$|[\t;])"
)


def find_thousands(lines: Sequence[str]) -> Mark:
    """Return the thousands separator; "" if no number proves one.

    Parameters
    ----------
    lines
        Lines of a file. In lines without tab or semicolon, only quoted numbers are inspected,
        because commas may separate columns.

    Examples
    --------
    >>> find_thousands(["1.234,5;2"]), find_thousands(["1,234.5,2"])
    ('.', '')
    >>> find_thousands(['"1,234.5",2']), find_thousands(["0,25;1.234", "0,26;987"])
    (',', '.')
    """
    lines = lines[:_ROWS]
    text = "\n".join(lines)
    for line in lines if _BOTH.search(text) else ():
        apart = any(mark in line for mark in _APART)
        if not apart and '"' not in line:
            continue
        for mark in _MARKS:
            decimal = "," if mark == "." else r"\." if mark == "," else "[.,]"
            number = rf"\d{{1,3}}(?:{re.escape(mark)}\d{{3}})+{decimal}\d+"
            if re.search(rf'(?:^|[\t;"]){_BLANK}*[+-]?{number}{_BLANK}*(?:$|[\t;"])', line):
                return mark
    return _separator_of_integers(lines) if _WHOLE.search(text) else ""


def _separator_of_integers(lines: Sequence[str]) -> Mark:
    """Return the separator of integers if other numbers use the other mark for decimals.

    1.234 in a column with 987, and in a table with 0,25, does not have three decimals.
    """
    columns: dict[int, set[str]] = {}
    for line in lines:
        for place, cell in enumerate(re.split("[\t;]", line)):
            if _NUMBER.fullmatch(cell):
                columns.setdefault(place, set()).add(cell.strip(" +-"))
    every = {cell for cells in columns.values() for cell in cells}
    for mark, decimal in ((".", ","), (",", ".")):
        plain = re.compile(rf"\d+{re.escape(decimal)}(?!\d{{3}}$)\d+")
        whole = re.compile(rf"[1-9]\d{{0,2}}(?:{re.escape(mark)}\d{{3}})+")
        if not any(plain.fullmatch(cell) for cell in every):
            continue
        marked = {cell for cell in every if mark in cell}
        small = any(
            cells & marked and any(cell.isdecimal() and len(cell) <= 3 for cell in cells)
            for cells in columns.values()
        )
        if small and all(whole.fullmatch(cell) for cell in marked):
            return "." if mark == "." else ","
    return ""


def without_thousands(text: str, mark: Mark, delimiter: str) -> str:
    """Return text without thousands separators.

    Parameters
    ----------
    text
        Lines of a table.
    mark
        Thousands separator.
    delimiter
        Delimiter of cells. If it equals the separator, only quoted numbers are changed.

    Examples
    --------
    >>> without_thousands("1.234,5;00:00.123", ".", ";")
    '1234,5;00:00.123'
    >>> without_thousands('1,234,"1,234.5"', ",", ",")
    '1,234,"1234.5"'
    """
    return _numbers(mark, delimiter).sub(lambda match: match[0].replace(mark, ""), text)


@functools.lru_cache(maxsize=16)
def _numbers(mark: str, delimiter: str) -> re.Pattern[str]:
    number = rf"[+-]?\d{{1,3}}(?:{re.escape(mark)}\d{{3}})+"
    if mark == delimiter:
        return re.compile(rf'(?<="){number}(?=(?:\.\d*)?")')
    decimal = "[.,]".replace(mark, "")
    return re.compile(rf"(?<![\w.,:'+-]){number}(?:{decimal}\d*)?(?![\w.,:'])")
