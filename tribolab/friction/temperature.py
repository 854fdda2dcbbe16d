"""Temperature and contact area recorded during the sliding of a run."""

from __future__ import annotations

import numpy as np
import xarray as xr

AREA = "contact_area_m2"  # attribute of a run and its friction


def sliding_temperature(run: xr.Dataset, segments: xr.Dataset) -> dict[str, float]:
    """Return mean and spread of the temperature of a run's segments; {} if none was recorded.

    Parameters
    ----------
    run
        With ``temperature`` [K] (time).
    segments
        From `tribolab.find_segments`.

    Returns
    -------
    dict
        ``temperature_K``, the mean of the segments, and ``temperature_spread_K``, their standard
        deviation.

    Examples
    --------
    >>> run = xr.Dataset({"temperature": ("time", [293.0, 293.0, 295.0])}, {"time": [0., 1., 2.]})
    >>> segments = xr.Dataset({"start": ("segment", [0., 2.]), "stop": ("segment", [1., 2.])})
    >>> sliding_temperature(run, segments)
    {'temperature_K': 294.0, 'temperature_spread_K': 1.0}
    """
    means = _means("temperature", run, segments)
    if not means:
        return {}
    return {"temperature_K": float(np.mean(means)), "temperature_spread_K": float(np.std(means))}


def sliding_area(run: xr.Dataset, segments: xr.Dataset) -> dict[str, float]:
    """Return the mean contact area of a run's segments, recorded or stated; {} if unknown.

    Parameters
    ----------
    run
        With ``contact_area`` [m2] (time), e.g. from a camera, or the attribute ``contact_area_m2``.
    segments
        From `tribolab.find_segments`.

    Examples
    --------
    >>> run = xr.Dataset({"contact_area": ("time", [2e-6, 4e-6])}, {"time": [0.0, 1.0]})
    >>> segments = xr.Dataset({"start": ("segment", [0.0]), "stop": ("segment", [1.0])})
    >>> sliding_area(run, segments)
    {'contact_area_m2': 3e-06}
    """
    means = _means("contact_area", run, segments)
    if means:
        return {AREA: float(np.mean(means))}
    return {AREA: float(run.attrs[AREA])} if AREA in run.attrs else {}


def _means(name: str, run: xr.Dataset, segments: xr.Dataset) -> list[float]:
    """Return the mean of a signal in each segment in which it is known."""
    if name not in run or run[name].dims != ("time",):
        return []
    time, values = run["time"].values, run[name].values
    first = np.searchsorted(time, segments["start"].values, "left")
    stop = np.searchsorted(time, segments["stop"].values, "right")
    parts = [values[a:b] for a, b in zip(first, stop, strict=True)]
    return [float(np.nanmean(part)) for part in parts if np.isfinite(part).any()]
