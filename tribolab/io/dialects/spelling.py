"""Numbers as few programs write them: −1.5 with a true minus sign, 1.5D-03, "1,5" in quotes."""

from __future__ import annotations

import re

_MINUS = "\u2212"
_TRUE_MINUS = re.compile(rf"{_MINUS}(?=[\d.,])")
_FORTRAN = re.compile(r"(?<=[\d.,])[Dd](?=[+-]\d{1,3}(?!\d))")
_IN_QUOTES = re.compile(r'"\s*([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)\s*"')
_WHOLE_IN_QUOTES = re.compile(r'"\s*([+-]?\d+(?:[eE][+-]?\d+)?)\s*"')
_ROW_IN_QUOTES = re.compile(
    r'(?:^|,)[^\S\n]*"[+-]?\d*,\d+(?:[eE][+-]?\d+)?"[^\S\n]*(?:,|$)', re.MULTILINE
)


def is_unusual(text: str) -> bool:
    """Whether a text holds numbers with a true minus sign, or Fortran's exponents.

    >>> is_unusual("0.1;−1.5"), is_unusual("1.0D-03 2.0D+00"), is_unusual("D-2 -1.5")
    (True, True, False)
    """
    if _MINUS in text and _TRUE_MINUS.search(text):
        return True
    exponents = any(part in text for part in ("D-", "D+", "d-", "d+"))
    return exponents and _FORTRAN.search(text) is not None


def usual(text: str) -> str:
    """Return text with its numbers written as most programs do.

    >>> usual("0.1;−1.5D-03")
    '0.1;-1.5E-03'
    """
    return _FORTRAN.sub("E", _TRUE_MINUS.sub("-", text))


def has_commas_in_quotes(text: str) -> bool:
    """Whether commas part the cells, and stand in numbers in quotes as decimal marks, too.

    >>> has_commas_in_quotes('"0,01","1,5"'), has_commas_in_quotes('"a, b",1.5')
    (True, False)
    """
    return _ROW_IN_QUOTES.search(text) is not None


def without_commas_in_quotes(text: str) -> str:
    """Return text whose numbers in quotes have a decimal point and no quotes.

    >>> without_commas_in_quotes('"0,01","-1,5e-3","2",Fx')
    '0.01,-1.5e-3,2,Fx'
    """
    return _WHOLE_IN_QUOTES.sub(r"\1", _IN_QUOTES.sub(r"\1.\2", text))
