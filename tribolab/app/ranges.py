"""Ranges in a line of the terminal."""

from __future__ import annotations


def range_of(low: str, high: str) -> str:
    """Return lowest to highest as written, once if they read the same.

    Examples
    --------
    >>> range_of("0.004", "0.004"), range_of("1", "2")
    ('0.004', '1 to 2')
    """
    return low if low == high else f"{low} to {high}"
