"""Ranges as text for the terminal."""

from __future__ import annotations


def range_of(low: str, high: str) -> str:
    """Return "low to high", or a single value if both texts are equal.

    Examples
    --------
    >>> range_of("0.004", "0.004"), range_of("1", "2")
    ('0.004', '1 to 2')
    """
    return low if low == high else f"{low} to {high}"
