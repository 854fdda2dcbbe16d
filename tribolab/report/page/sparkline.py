"""Small picture of a run's trace, for a row of a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tribolab.records.packed import unpack_points

WIDTH, HEIGHT = 150, 30  # size of the picture in its own units
_COLUMNS = 50  # columns of the picture, each drawn from its minimum to its maximum


def spark_path(trace: Mapping[str, Any]) -> str:
    """Return the main signal of a trace against time as an SVG path, `WIDTH` by `HEIGHT`.

    Parameters
    ----------
    trace
        From `tribolab.records.runs.traces.decimated_trace`.
    """
    places, values = unpack_points(trace["signals"][0])
    knots, at_s = trace["clock"]
    known = np.isfinite(values)
    if known.sum() < 2 or not trace["length_s"] > 0:
        return ""
    time = np.interp(places[known], knots, at_s) / trace["length_s"]
    low, high = values[known].min(), values[known].max()
    y = HEIGHT * (1 - (values[known] - low) / (high - low)) if high > low else 0 * time + HEIGHT / 2
    column = np.minimum((time * _COLUMNS).astype(int), _COLUMNS - 1)
    first = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.c_[np.maximum.reduceat(y, first), np.minimum.reduceat(y, first)]
    ends[1::2] = ends[1::2, ::-1]  # alternate, so that neighbouring columns join at one end
    x = np.round((column[first] + 0.5) * WIDTH / _COLUMNS).astype(int)
    points = [
        f"{a},{round(b)}" for a, pair in zip(x, ends, strict=True) for b in dict.fromkeys(pair)
    ]
    return f"M{' '.join(points)}"
