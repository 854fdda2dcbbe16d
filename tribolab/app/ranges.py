"""Ranges as text for the terminal."""

from __future__ import annotations


def range_of(low: str, high: str) -> str:
    """Return a range as text; a single value if both ends read the same.

    Examples
    --------
    >>> range_of("0.004", "0.004"), range_of("1", "2")
    ('0.004', '1 to 2')
    """
    return low if low == high else f"{low} to {high}"
