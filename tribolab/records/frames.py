"""Results over one dimension as tables: a row per segment or point, units in the names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from tribolab.friction.coefficient.steadiness import WORDS
from tribolab.plot.look.labels import column
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
]


def frame(data: xr.Dataset, dim: str, first: Sequence[str] = ()) -> pd.DataFrame:
    """Return the variables over one dimension as a table.

    Parameters
    ----------
    data
        Any result of this package.
    dim
        The dimension whose entries become rows.
    first
        Variables that stand first, in this order; the others follow as in the dataset.

    Returns
    -------
    pandas.DataFrame
        Columns are called as the variables with their unit; text stays text.
    """
    # not data[name], which puts coordinates around each: of a hundred variables that takes longer
    # than all the rest
    names = [str(n) for n, variable in data.variables.items() if variable.dims == (dim,)]
    ordered = [n for n in first if n in names] + [n for n in names if n not in first]
    columns = {}
    for name in ordered:
        values = data.variables[name].values
        columns[name if values.dtype.kind in "OUS" else column(name)] = values
    return pd.DataFrame(columns)


def rows_of(table: pd.DataFrame) -> list[Row]:
    """Return the rows of a table, each by the names of the columns.

    Examples
    --------
    >>> rows_of(pd.DataFrame({"medium": ["dry"], "normal_force_N": [31.0]}))
    [{'medium': 'dry', 'normal_force_N': 31.0}]
    """
    names = [str(name) for name in table.columns]
    columns = [table[name].tolist() for name in table.columns]
    return [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]


def plain_rows(table: pd.DataFrame) -> tuple[Row, ...]:
    """Return the rows of a table as a record keeps them: plain numbers, None where not known."""
    return tuple(plain_value(rows_of(table)))


def friction_table(friction: xr.Dataset) -> pd.DataFrame:
    """Return a run's friction result as a table, a row per segment, numbered from 1."""
    table = frame(friction, "segment", _FRICTION_FIRST)
    number = np.arange(1, friction.sizes["segment"] + 1)
    table = table.drop(columns="segment", errors="ignore")
    if "steady" in table:
        table["steady"] = table["steady"].map(WORDS)
    table.insert(0, "segment", number)
    return table


def curve_table(curve: xr.Dataset) -> pd.DataFrame:
    """Return a measured curve as a table, a row per sliding speed."""
    return frame(curve, "sliding_speed", _CURVE)


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


def static_friction_table(starts: xr.Dataset) -> pd.DataFrame:
    """Return a run's static friction as a table, a row per start, its segment numbered from 1."""
    table = frame(starts, "start_of_sliding", _START)
    table = table.drop(columns="start_of_sliding", errors="ignore")
    table.insert(0, "segment", starts["start_of_sliding"].values + 1)
    return table


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


def stick_slip_table(slip: xr.Dataset) -> pd.DataFrame:
    """Return a run's stick-slip as a table, a row per segment, numbered from 1."""
    table = frame(slip, "segment", _FIRST).drop(columns="segment", errors="ignore")
    probability = slip["class_probability"].max("waveform_class").values
    table.insert(3, "class_probability", probability)
    table.insert(0, "segment", np.arange(1, slip.sizes["segment"] + 1))
    return table
