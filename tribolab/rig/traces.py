"""Simulation of friction along a single stroke, with known stick-slip and noise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_lists
from tribolab.core.errors import AnalysisError, nearest
from tribolab.rig.noise import slow_noise
from tribolab.rig.waves import JITTER, WAVES
from tribolab.units.stamping import stamp

_FINE = 400  # points per period, for computing true values


@of_lists("form", "wavelength", "drop", "noise", "samples", "speed", "seed")
def simulate_trace(
    form: str = "sawtooth",
    *,
    wavelength: float = 22e-6,
    drop: float = 0.2,
    noise: float = 0.01,
    red: float = 0.5,
    periods: float = 25.0,
    samples: int = 4000,
    speed: float = 1e-6,
    level: float = 1.0,
    scatter: float = JITTER,
    red_length: float = 0.01,
    jitter: float = 0.0,
    seed: int | np.random.Generator = 0,
) -> xr.Dataset:
    """Return a run with the simulated friction coefficient along one stroke at constant speed.

    Form, wavelength, drop, noise, samples, speed and seed may be lists of equal length: then the
    result is a list, whose n-th run has the n-th values.

    Parameters
    ----------
    form
        ``"sawtooth"``, ``"rounded"``, ``"irregular"`` or ``"none"``.
    wavelength, drop
        Mean distance between drops of friction [m] and their mean size [1].
    noise, red
        Standard deviation of all noise [1], and the share of its variance that is slow, as friction
        fluctuates along a track (see `red_length`); the rest is white noise.
    periods, samples
        Length of the stroke in wavelengths, and number of samples.
    speed, level
        Sliding speed [m/s] and mean friction coefficient.
    scatter
        Relative standard deviation of the periods and of the drops.
    red_length
        Correlation length of the slow noise, relative to the stroke.
    jitter
        Standard deviation of the sampling time, in sampling intervals.
    seed
        Seed or generator.

    Returns
    -------
    xarray.Dataset
        A run: ``friction_coefficient`` and ``sliding_velocity`` on ``time``. Attributes: ``form``,
        and the actual ``wavelength_m`` and ``drop`` of this stroke (NaN if none).

    Examples
    --------
    >>> run = simulate_trace("sawtooth", noise=0.0, seed=1)
    >>> 18e-6 < run.attrs["wavelength_m"] < 26e-6, run.sizes["time"]
    (True, 4000)
    """
    if form != "none" and form not in WAVES:
        known = ("none", *WAVES)
        raise AnalysisError(f"the rig has no waveform '{form}'{nearest(form, known)}")
    rng = np.random.default_rng(seed)
    length = periods * wavelength
    spacing = length / speed / samples
    time = spacing * (np.arange(samples) + jitter * rng.standard_normal(samples).clip(-5, 5))
    time = np.maximum.accumulate(time - time[0])
    time += 1e-9 * spacing * np.arange(samples)
    friction = np.full(samples, level)
    truth = {"wavelength_m": np.nan, "drop": np.nan}
    if form != "none":
        wave = WAVES[form](rng, length, wavelength, drop, scatter)
        friction += wave(time * speed)
        truth = _truth(wave, length, wavelength)
    slow = slow_noise(rng, float(time[-1]) + spacing, red_length * float(time[-1]))
    friction += noise * np.sqrt(red) * slow(time)
    friction += noise * np.sqrt(1 - red) * rng.standard_normal(samples)
    data = {
        "friction_coefficient": ("time", friction),
        "sliding_velocity": ("time", np.full(samples, speed)),
    }
    return stamp(xr.Dataset(data, {"time": time}), form=form, **truth)


def _truth(
    wave: Callable[[np.ndarray], np.ndarray], length: float, wavelength: float
) -> dict[str, float]:
    """Return the actual mean distance between peaks [m] and mean drop of a wave without noise."""
    place = np.linspace(0, length, int(_FINE * length / wavelength))
    values = wave(place)
    rising = np.diff(values) > 0
    peak = np.flatnonzero(rising[:-1] & ~rising[1:]) + 1
    valley = np.flatnonzero(~rising[:-1] & rising[1:]) + 1
    if peak.size < 2:
        return {"wavelength_m": np.nan, "drop": np.nan}
    valley = valley[valley > peak[0]]
    count = min(peak.size, valley.size)
    return {
        "wavelength_m": float(np.diff(place[peak]).mean()),
        "drop": float((values[peak[:count]] - values[valley[:count]]).mean()),
    }
