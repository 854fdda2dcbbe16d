"""Metadata of arrays and datasets: names and units of the quantities, and origin."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.units.quantities import QUANTITIES, quantity, si_values


def stamp(data: xr.Dataset, **attrs: str | float | int) -> xr.Dataset:
    """Return a dataset in which each variable has the ``units`` and ``long_name`` of its quantity.

    Attributes left over from arithmetic (F_x/F_N would still have "N") are overwritten. Flags
    (``*_qc``, ``*_qc_tests``) keep their own attributes; text variables get a long name only if
    known.

    Parameters
    ----------
    data
        Dataset whose variable names are in the dictionary.
    **attrs
        Attributes to add to the dataset.

    Raises
    ------
    TribolabError
        If a numeric variable's name is not in the dictionary.
    """
    result = data.copy()
    for name, variable in result.variables.items():
        if str(name).endswith(("_qc", "_qc_tests")):
            continue
        if variable.dtype.kind in "OUSTM":
            if name in QUANTITIES:
                variable.attrs["long_name"] = QUANTITIES[str(name)].long_name
            continue
        known = quantity(str(name))
        is_force = name == "load" and variable.attrs.get("units") == "N"  # the load of a ball
        unit = "N" if is_force else known.unit
        variable.attrs.update(units=unit, long_name=known.long_name)
    result.attrs.update(attrs)
    return result


def stamp_array(data: xr.DataArray, name: str) -> xr.DataArray:
    """Return the array under the quantity's name with only its ``units`` and ``long_name``."""
    known = quantity(name)
    result = data.rename(name)
    result.attrs = {"units": known.unit, "long_name": known.long_name}
    return result


def labelled(value: str | ArrayLike | xr.DataArray, name: str) -> xr.DataArray:
    """Return a quantity, given in any form, as a DataArray of floats.

    Parameters
    ----------
    value
        Text with a unit, a number, a one-dimensional array or list of either (it becomes its own
        coordinate) or a DataArray (any dims); numbers are in the quantity's SI unit.
    name
        The quantity.

    Raises
    ------
    UnitError
        If a text has no unit or one of another dimension, or an entry is no number.
    AnalysisError
        If an array has two or more dimensions and no names for them.

    Examples
    --------
    >>> labelled([1e4, 1e5], "pressure").dims
    ('pressure',)
    """
    if isinstance(value, xr.DataArray):
        if value.dtype.kind in "fiub":
            return value.astype(float)
        return value.copy(data=si_values(value.values, name))
    values = si_values(value, name)
    if values.ndim > 1:
        raise AnalysisError(
            f"{name}: an array with two or more dimensions must be a DataArray that names them"
        )
    dims = (name,)[: values.ndim]
    data = xr.DataArray(values, coords={dim: values for dim in dims}, dims=dims)
    return stamp_array(data, name)


def like(values: np.ndarray, given: str | ArrayLike | xr.DataArray, name: str) -> Any:
    """Return values in the form of another argument: a float, an array or a stamped DataArray."""
    if isinstance(given, xr.DataArray):
        return stamp_array(xr.DataArray(values, coords=given.coords, dims=given.dims), name)
    return values[()] if np.ndim(values) else float(values)
