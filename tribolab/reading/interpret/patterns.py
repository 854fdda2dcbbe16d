"""Readable patterns for text lines."""

from __future__ import annotations

import re

from tribolab.reading.numbers import NUMBER

_SPECIAL = re.compile(r"([.^$*+?{}\[\]\\|()])")


def escaped(text: str) -> str:
    """Return text as a readable pattern: blanks remain blanks."""
    return _SPECIAL.sub(r"\\\1", text).replace("\t", r"\t")


def number_pattern(before: str) -> str:
    """Return a pattern for the number after a line's beginning, in which numbers may vary.

    >>> re.search(number_pattern("# cell 2: "), "# cell 3: 4.5 N")[1]
    '4.5'
    """
    parts = re.split(r"\d[\d.,]*", before.strip())
    return r"^\s*" + r"[\d.,]+".join(map(escaped, parts)) + rf"\s*({NUMBER})"
