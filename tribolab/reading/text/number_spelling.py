"""Rare number notations: −1.5 with a true minus sign, 1.5D-03, "1,5" in quotes."""

from __future__ import annotations

import re

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
    """Return cells without the unit of their column."""
    if len(cells) != len(units):
        return cells
    matches = ((cell, _CELL.fullmatch(cell), unit) for cell, unit in zip(cells, units, strict=True))
    return [found[1] if found and found[2] == unit else cell for cell, found, unit in matches]


def has_commas_in_quotes(text: str) -> bool:
    """Whether commas separate cells and are also decimal marks of quoted numbers.

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
