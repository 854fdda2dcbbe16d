"""Signals of a run as arrays, which are available sooner than a dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.core.untyped import Json

if TYPE_CHECKING:
    import xarray as xr


class Signals(NamedTuple):
    """Time [s] (time), columns in SI by quantity (time), and attributes of the run."""

    time: np.ndarray
    columns: dict[str, np.ndarray]
    attrs: Json


def dataset_of(signals: Signals) -> xr.Dataset:
    """Return signals as a dataset with dim ``time``, and units and names on every variable.

    Examples
    --------
    >>> run = dataset_of(Signals(np.array([0.0, 1.0]), {"normal_force": np.array([5.0, 6.0])}, {}))
    >>> run["normal_force"].attrs["units"]
    'N'
    """
    # imported late: pandas and xarray take longer to load than a file of 5 MB takes to read
    import pandas as pd
    import xarray as xr
    from xarray.indexes import PandasIndex

    # imported late, as it imports xarray
    from tribolab.units.stamping import stamp

    return stamp(
        xr.Dataset(
            {name: ("time", values) for name, values in signals.columns.items()},
            coords=xr.Coordinates.from_xindex(
                PandasIndex(pd.Index(signals.time, copy=False), "time")
            ),
            attrs=signals.attrs,
        )
    )


def signals_of(run: xr.Dataset) -> Signals:
    """Return the signals of a dataset as arrays."""
    columns = {str(name): run[name].to_numpy() for name in run.data_vars}
    return Signals(run["time"].to_numpy(), columns, dict(run.attrs))
