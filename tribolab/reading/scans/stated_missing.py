"""Sentinels for missing heights that a file's header states: "no data: -99999"."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label

_SINGLE_PRECISION = 2e-7  # relative precision of a single-precision number
_TWICE = 2
_PARAMETER = re.compile(r"\b[RS]\w{1,2}\b")  # roughness parameters: Ra, Sq


def take_stated(
    values: np.ndarray, stated: Iterable[tuple[str, float]]
) -> list[tuple[str, float, int]]:
    """Replace sentinels stated in the header by NaN.

    Parameters
    ----------
    values
        Heights as in the file; changed in place.
    stated
        Names and numbers without units in the header.

    Returns
    -------
    list of tuple
        Name, number and occurrences of each sentinel. A number with an unknown name is a sentinel
        if it is repeated and far outside all other heights.

    Examples
    --------
    >>> heights = np.array([1.0, -999.0, 3.0, -999.0])
    >>> take_stated(heights, [("rows", 3.0), ("puuttuva arvo", -999.0)]), heights.tolist()
    ([('puuttuva arvo', -999.0, 2)], [1.0, nan, 3.0, nan])
    """
    taken = []
    for name, number in stated:
        here = np.abs(values - number) <= _SINGLE_PRECISION * abs(number)
        count = int(here.sum())
        if not count or not _is_mark(values, here, name, number):
            continue
        values[here] = np.nan
        taken.append((name, number, count))
    return taken


def _is_mark(values: np.ndarray, here: np.ndarray, name: str, number: float) -> bool:
    """Whether a stated number is a sentinel and not e.g. a count ("missing: 5").

    A number whose name says so may be within the range of heights: "no data value: 0".
    """
    rest = values[~here & np.isfinite(values)]
    if not rest.size:
        return False
    low, high = float(rest.min()), float(rest.max())
    outside = max(low - number, number - high)
    key = normalise_label(name)
    if key_pattern("no_height").search(key):
        counted = "%" in name or key_pattern("how_many").search(key)
        return outside > 0 or bool(key_pattern("as_value").search(key) and not counted)
    result = _PARAMETER.search(name) or key_pattern("of_heights").search(key)
    return outside > high - low and int(here.sum()) >= _TWICE and not result
