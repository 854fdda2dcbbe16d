"""Search for numbers in text in any language, with the unit that follows each number."""

from __future__ import annotations

import functools
import math
import re
from typing import NamedTuple

NUMBER = r"[-+]?\d[\d.,]*(?:[eE][-+]?\d+)?"
_A_PER = r"(?:/|\b(?:per|pro|par|por)\b)"
_UNIT = (
    rf"{_A_PER}\s?[^\W\d_]\w*|1/[^\W\d]\w*|%|°[A-Za-z]?"
    rf"|[^\W\d_][^\s;,:()\[\]\"，；：（）、。=≙≈≅→]*(?:\s?{_A_PER}\s?[^\W\d_]\w*)?"
)
_NUMBER = re.compile(rf"(?<![\d.,A-Za-z_])(?P<number>{NUMBER})(?:\s{{0,3}}(?P<unit>{_UNIT}))?")
PLAIN_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?")  # a whole cell
_SPECIAL = re.compile(r"([.^$*+?{}\[\]\\|()])")
_PER = re.compile(rf"\s?{_A_PER}\s?")


class Number(NamedTuple):
    """Number in a text: digits, the word after them (perhaps a unit), start and end index."""

    text: str
    unit: str
    start: int
    end: int

    @property
    def stop(self) -> int:
        """Index in the text at which the digits end."""
        return self.start + len(self.text)

    @property
    def value(self) -> float:
        """The number as a float; NaN if the digits are no number, such as 1.234,5."""
        return decimal(self.text)


def decimal(text: str) -> float:
    """Return text with a decimal point or comma as a float; NaN if it is not a number.

    >>> decimal("21,5"), decimal("-4.2e3,"), decimal("1.234,5")
    (21.5, -4200.0, nan)
    """
    try:
        return float(text.strip().rstrip(".,").replace(",", "."))
    except ValueError:
        return math.nan


@functools.lru_cache(maxsize=4096)
def numbers_in(text: str) -> tuple[Number, ...]:
    """Return the numbers in a text, each with the word that follows it.

    Parameters
    ----------
    text
        At most one line.

    Examples
    --------
    >>> [(n.value, n.unit) for n in numbers_in("radius 21,5 mm, 4 points per um, 1:5")]
    [(21.5, 'mm'), (4.0, 'points/um'), (1.0, ''), (5.0, '')]
    """
    return tuple(
        Number(
            match["number"].rstrip(".,"),
            _PER.sub("/", (match["unit"] or "").rstrip(".!?")),
            match.start(),
            match.end(),
        )
        for match in _NUMBER.finditer(text)
    )


def escaped(text: str) -> str:
    """Return a regular expression for a text, without escaping its blanks."""
    return _SPECIAL.sub(r"\\\1", text).replace("\t", r"\t")


def number_pattern(before: str) -> str:
    """Return a pattern for the number after the text `before`; numbers in that text may differ.

    >>> re.search(number_pattern("# cell 2: "), "# cell 3: 4.5 N")[1]
    '4.5'
    """
    parts = re.split(r"\d[\d.,]*", before.strip())
    return r"^\s*" + r"[\d.,]+".join(map(escaped, parts)) + rf"\s*({NUMBER})"
