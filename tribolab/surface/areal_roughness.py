"""Areal roughness of height maps: Sq and Sa of ISO 25178."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.units.stamping import stamp


def areal_roughness(scans: xr.Dataset) -> xr.Dataset:
    """Return Sq and Sa, the rms and the mean absolute height of a map, over all wavelengths.

    Parameters
    ----------
    scans
        ``height`` [m] (..., y, x) without form. Missing and filled heights (``dropout``) are
        ignored.

    Returns
    -------
    xarray.Dataset
        ``Sq`` and ``Sa`` [m], with the dims of the heights except x and y. Heights are relative to
        their mean; no waves are filtered out.

    Raises
    ------
    AnalysisError
        If the scans are profiles, or a map has no height.

    References
    ----------
    .. [1] ISO 25178-2:2021, 4.2.1 and 4.2.7 (of the scale-limited surface).

    Examples
    --------
    >>> lay = 1e-6 * np.array([[1.0, 1.0], [-1.0, -1.0]])
    >>> said = areal_roughness(xr.Dataset({"height": (("y", "x"), lay)}))
    >>> float(said.Sq), float(said.Sa)
    (1e-06, 1e-06)
    """
    height = scans["height"]
    if not {"x", "y"} <= set(height.dims):
        raise AnalysisError("profiles have no areal roughness", function="areal_roughness")
    if "dropout" in scans:
        height = height.where(scans["dropout"] == 0)
    if not bool(height.notnull().any(("y", "x")).all()):
        raise AnalysisError("a map has no height", function="areal_roughness")
    deviation = height - height.mean(("y", "x"))
    values = {
        "Sq": np.sqrt((deviation**2).mean(("y", "x"))),
        "Sa": xr.DataArray(np.abs(deviation)).mean(("y", "x")),
    }
    return stamp(xr.Dataset(values))
