"""Tables of results over one dimension, with units in the column names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from tribolab.figures.labels import column
from tribolab.friction.coefficient.steadiness import STEADINESS_WORDS
from tribolab.records.parts import Row
from tribolab.records.wording import plain_value

if TYPE_CHECKING:
    import xarray as xr


_FRICTION_FIRST = [
    "sliding_speed",
    "direction",
    "friction_coefficient",
    "friction_coefficient_std",
    "friction_coefficient_sem",
    "friction_coefficient_u",
    "friction_coefficient_dof",
    "friction_coefficient_U95",
    "effective_samples",
    "friction_force",
    "friction_force_std",
    "friction_force_sem",
    "normal_force",
    "normal_force_std",
    "half_loop",
    "pair",
    "start",
    "stop",
    "trimmed_start",
    "trimmed_stop",
    "sliding_distance",
    "samples",
]


_CURVE = [
    "sliding_speed",
    "friction_coefficient",
    "friction_coefficient_std",
    "friction_coefficient_sem",
    "friction_coefficient_u",
    "friction_coefficient_dof",
    "friction_coefficient_U95",
    "friction_coefficient_within",
    "friction_coefficient_between",
    "runs",
    "segments",
    "rolling_speed",
]


def frame(data: xr.Dataset, dim: str, first: Sequence[str] = ()) -> pd.DataFrame:
    """Return a table of the variables over one dimension.

    Parameters
    ----------
    data
        Any result of this package.
    dim
        The dimension whose entries become rows.
    first
        First variables, in this order; the others follow as in the dataset.

    Returns
    -------
    pandas.DataFrame
        Columns are named after the variables, with their unit; text stays text.
    """
    return pd.DataFrame(columns_of(data, dim, first))


def columns_of(data: xr.Dataset, dim: str, first: Sequence[str] = ()) -> dict[str, np.ndarray]:
    """Return the columns of the table from `frame`, for the same arguments."""
    # not data[name], which adds coordinates to each: for a hundred variables that takes longer
    # than the rest
    names = [str(n) for n, variable in data.variables.items() if variable.dims == (dim,)]
    ordered = [n for n in first if n in names] + [n for n in names if n not in first]
    columns = {}
    for name in ordered:
        values = data.variables[name].values
        columns[name if values.dtype.kind in "OUS" else column(name)] = values
    return columns


def rows_of(table: pd.DataFrame | Mapping[str, np.ndarray]) -> list[Row]:
    """Return rows of a table as dictionaries by column.

    Examples
    --------
    >>> rows_of(pd.DataFrame({"medium": ["dry"], "normal_force_N": [31.0]}))
    [{'medium': 'dry', 'normal_force_N': 31.0}]
    """
    names = [str(name) for name in table]
    columns = [table[name].tolist() for name in names]
    return [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]


def plain_rows(table: pd.DataFrame | Mapping[str, np.ndarray]) -> tuple[Row, ...]:
    """Return rows of a table for a record: plain numbers, None if unknown."""
    return tuple(plain_value(rows_of(table)))


def friction_columns(friction: xr.Dataset) -> dict[str, np.ndarray]:
    """Return columns of a run's friction result, a row per segment, numbered from 1.

    No `pandas.DataFrame` is made, which would take most of the time for a small run.
    """
    columns = columns_of(friction, "segment", _FRICTION_FIRST)
    if "steady" in columns:
        steady = [STEADINESS_WORDS.get(value) for value in columns["steady"].tolist()]
        columns["steady"] = np.array(steady, dtype=object)
    return {"segment": np.arange(1, friction.sizes["segment"] + 1)} | _drop("segment", columns)


def _drop(name: str, columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {key: values for key, values in columns.items() if key != name}


def curve_table(curve: xr.Dataset) -> pd.DataFrame:
    """Return a table of a measured curve, a row per sliding speed."""
    return frame(curve, "sliding_speed", _CURVE)


def traction_table(traction: xr.Dataset) -> dict[str, np.ndarray]:
    """Return friction against the slide-roll ratio as columns, one row per point."""
    return _drop("point", columns_of(traction, "point", ["rolling_speed", "slide_roll_ratio"]))


_START = [
    "direction",
    "sliding_speed",
    "waiting_time",
    "static_friction_coefficient",
    "static_friction_coefficient_sem",
    "friction_coefficient",
    "static_excess",
    "peak",
]


def static_friction_columns(starts: xr.Dataset) -> dict[str, np.ndarray]:
    """Return columns of a run's static friction, one row per start; segments count from 1."""
    columns = _drop("start_of_sliding", columns_of(starts, "start_of_sliding", _START))
    return {"segment": starts["start_of_sliding"].values + 1} | columns


_FIRST = [
    "sliding_speed",
    "direction",
    "waveform",
    "regularity",
    "oscillating_time_share",
    "dominant_frequency",
    "dominant_wavelength",
    "recurrence_distance",
    "drop",
    "events",
]


def stick_slip_columns(slip: xr.Dataset) -> dict[str, np.ndarray]:
    """Return columns of a run's stick-slip, a row per segment, numbered from 1."""
    number = {"segment": np.arange(1, slip.sizes["segment"] + 1)}
    columns = list(_drop("segment", columns_of(slip, "segment", _FIRST)).items())
    probability = slip["class_probability"].max("waveform_class").values
    return number | dict([*columns[:3], ("class_probability", probability), *columns[3:]])
