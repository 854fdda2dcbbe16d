"""Temperature recorded during the sliding of a run."""

from __future__ import annotations

import numpy as np
import xarray as xr


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
    if "temperature" not in run or run["temperature"].dims != ("time",):
        return {}
    time, kelvin = run["time"].values, run["temperature"].values
    first = np.searchsorted(time, segments["start"].values, "left")
    stop = np.searchsorted(time, segments["stop"].values, "right")
    parts = [kelvin[a:b] for a, b in zip(first, stop, strict=True)]
    means = [float(np.nanmean(part)) for part in parts if np.isfinite(part).any()]
    if not means:
        return {}
    return {
        "temperature_K": float(np.mean(means)),
        "temperature_spread_K": float(np.std(means)),
    }
