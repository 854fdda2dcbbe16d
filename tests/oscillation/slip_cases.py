"""Runs of one segment whose friction is known, for the tests of stick-slip."""

import numpy as np
import xarray as xr

from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.units.stamping import stamp


def a_run(values, spacing=0.1, speed=1e-6, time=None):
    values = np.asarray(values, dtype=float)
    time = spacing * np.arange(values.size) if time is None else time
    data = {
        "friction_coefficient": ("time", values),
        "sliding_velocity": ("time", np.full(values.size, speed)),
    }
    return stamp(xr.Dataset(data, {"time": time}))


def whole(run):
    """One segment over the whole run, whatever is in it."""
    time = run["time"].values
    data = {
        "start": time[:1],
        "stop": time[-1:],
        "trimmed_start": time[:1],
        "trimmed_stop": time[-1:],
        "sliding_speed": np.array([1e-6]),
        "direction": np.array([1], np.int8),
        "sliding_distance": np.array([1e-6 * (time[-1] - time[0])]),
    }
    return xr.Dataset({k: ("segment", v) for k, v in data.items()}, {"segment": [0]})


def saw(turns, fall=0.06):
    phase = turns % 1.0
    return np.where(phase < 1 - fall, phase / (1 - fall), (1 - phase) / fall)


def noisy(values, seed=0, size=0.01):
    return 1 + values + size * np.random.default_rng(seed).standard_normal(values.size)


def seen(values, spacing=0.02):
    run = a_run(values, spacing)
    return stick_slip(run, whole(run)).isel(segment=0)
