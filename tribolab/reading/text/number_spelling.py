"""Unusual notations of numbers: −1.5 with a true minus sign, 1.5D-03, "1,5" in quotes, 1.234,5."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence
from typing import Literal

_MINUS = "\u2212"
_TRUE_MINUS = re.compile(rf"{_MINUS}(?=[\d.,])")
_FORTRAN = re.compile(r"(?<=[\d.,])[Dd](?=[+-]\d{1,3}(?!\d))")
_IN_QUOTES = re.compile(r'"\s*([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)\s*"')
_WHOLE_IN_QUOTES = re.compile(r'"\s*([+-]?\d+(?:[eE][+-]?\d+)?)\s*"')
_VALUE = r"[^\S\n]*[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"
_UNIT_BEHIND = r"[^\S\n]?(?:[^\W\d_\n]|°|%)[^\s;,\d]{0,7}"
_MAY_HAVE = rf"{_VALUE}(?:{_UNIT_BEHIND})?"
# "10.0 mm;3.0 N;1": at least two cells have a unit
_ROW_WITH_UNITS = re.compile(
    rf"^(?:{_MAY_HAVE}(?P<mark>[\t;,]))??{_VALUE}{_UNIT_BEHIND}[\t;,](?:{_MAY_HAVE}[\t;,])*?"
    rf"{_VALUE}{_UNIT_BEHIND}(?:[\t;,]{_MAY_HAVE})*[^\S\n]*$",
    re.MULTILINE,
)
_CELL = re.compile(rf"({_VALUE})[^\S\n]?((?:[^\W\d_\n]|°|%)[^\s;,\d]{{0,7}})[^\S\n]*")
_MIN_ROWS = 3
_LOOKED_AT = 1 << 14  # characters inspected
_ROW_IN_QUOTES = re.compile(
    r'(?:^|,)[^\S\n]*"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"[^\S\n]*(?:,|$)', re.MULTILINE
)


def is_unusual(text: str) -> bool:
    """Whether numbers have a true minus sign, Fortran exponents, or a unit after them.

    >>> is_unusual("0.1;−1.5"), is_unusual("1.0D-03 2.0D+00"), is_unusual("D-2 -1.5")
    (True, True, False)
    """
    if _MINUS in text and _TRUE_MINUS.search(text):
        return True
    if len(_ROW_WITH_UNITS.findall(text[:_LOOKED_AT])) >= _MIN_ROWS:
        return True
    exponents = any(part in text for part in ("D-", "D+", "d-", "d+"))
    return exponents and _FORTRAN.search(text) is not None


def usual(text: str) -> str:
    """Return text with its numbers in the usual notation.

    >>> usual("0.1;−1.5D-03")
    '0.1;-1.5E-03'
    """
    text = _FORTRAN.sub("E", _TRUE_MINUS.sub("-", text))
    first = _ROW_WITH_UNITS.search(text)
    return text if first is None else _units_to_names(text, first)


def _units_to_names(text: str, first: re.Match[str]) -> str:
    r"""Move the units after a table's numbers to the names above it.

    >>> rows = "10.0 mm;3.0 N;1\n" * 3
    >>> usual("Weg;Kraft;n\n" + rows).splitlines()[:2]
    ['Weg [mm];Kraft [N];n', '10.0;3.0;1']
    """
    mark = next(m for m in "\t;," if m in first[0])
    units = [found[2] if (found := _CELL.fullmatch(cell)) else "" for cell in first[0].split(mark)]
    above, rows = text[: first.start()], text[first.start() :].split("\n")
    head, end, names = above.rstrip("\n").rpartition("\n")
    cells = names.split(mark)
    if len(cells) == len(units):
        named = (f"{c.strip()} [{u}]" if u else c for c, u in zip(cells, units, strict=True))
        above = f"{head}{end}{mark.join(named)}\n"
    return above + "\n".join(mark.join(_without_units(row.split(mark), units)) for row in rows)


def _without_units(cells: list[str], units: list[str]) -> list[str]:
    """Return the cells of a row with the unit of each column removed."""
    if len(cells) != len(units):
        return cells
    matches = ((cell, _CELL.fullmatch(cell), unit) for cell, unit in zip(cells, units, strict=True))
    return [found[1] if found and found[2] == unit else cell for cell, found, unit in matches]


def has_commas_in_quotes(text: str) -> bool:
    """Whether commas separate cells, and quoted numbers have decimal commas.

    >>> has_commas_in_quotes('"0,01","1,5"'), has_commas_in_quotes('"a, b",1.5')
    (True, False)
    """
    return _ROW_IN_QUOTES.search(text) is not None


def without_commas_in_quotes(text: str) -> str:
    """Return text whose quoted numbers have a decimal point and no quotes.

    >>> without_commas_in_quotes('"0,01","-1,5e-3","2",Fx')
    '0.01,-1.5e-3,2,Fx'
    """
    return _WHOLE_IN_QUOTES.sub(r"\1", _IN_QUOTES.sub(r"\1.\2", text))


Mark = Literal["", ".", ",", "'", " ", "\u00a0", "\u202f"]
_MARKS: tuple[Mark, ...] = (".", ",", "'", " ", "\u00a0", "\u202f")
_ROWS = 4000  # most lines inspected
_NUMBER = re.compile(r"\s*[+-]?\d[\d.,]*\s*")
_APART = "\t;"  # delimiters that are no thousands separators
_BLANK = r"[^\S\t\n]"  # a blank in a cell, no tab: a search scans a row of empty cells only once
# patterns of numbers with thousands separator and decimal mark, and of integers with separators
_BOTH = re.compile(rf"\d[{''.join(_MARKS)}]\d{{3}}[.,]\d")
_WHOLE = re.compile(
    rf"(?m)(?:^|[\t;])(?:{_BLANK}|[+-])*[1-9]\d{{0,2}}(?:[.,]\d{{3}})+{_BLANK}*(?:$|[\t;])"
)


def find_thousands(lines: Sequence[str]) -> Mark:
    """Return the thousands separator of the numbers in lines; "" if no number proves one.

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
    """Return the thousands separator of integers if other numbers have the other mark, else "".

    Example: 1.234 is an integer if its column contains 987 and the table contains 0,25.
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
