"""Runs whose force has a known zero, and what the analysis makes of it."""

import numpy as np
import xarray as xr

from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.qc.run.checks import check_run

MU, LOAD, SPEED = 0.3, 31.0, 1e-3


def programme(
    speeds,
    *,
    mu=lambda v: np.full(np.shape(v), MU),
    zero=lambda u: 0.0 * u,
    normal_zero=lambda u: 0.0 * u,
    loaded_rests=False,
    samples=300,
    turn=4,
    noise=0.02,
    seed=0,
):
    """Strokes at signed speeds with unloaded rests before, after and, where None stands, between.

    `mu` follows the signed speed, `zero` and `normal_zero` [N] the share of the run that passed.
    Friction turns over within `turn` samples of a reversal.
    """
    rng = np.random.default_rng(seed)
    speed, load = [], []
    for v in (None, *speeds, None):
        if v is None:
            speed += [np.zeros(120)]
            load += [np.r_[np.zeros(5), np.full(100, float(loaded_rests)), np.ones(15)]]
            load[-1][:105] = float(loaded_rests)
        else:
            leg = np.linspace(0, v, turn + 2)[1:-1]
            speed += [np.r_[leg, np.full(samples, v), leg[::-1], 0.0]]
            load += [np.ones(speed[-1].size)]
    v, pressed = np.concatenate(speed), np.concatenate(load)
    pressed[-100:] = float(loaded_rests)
    time = 0.01 * np.arange(v.size)
    share = time / time[-1]
    top = np.abs(v).max()
    built = np.clip(v / (0.5 * np.min(np.abs([s for s in speeds if s]))), -1, 1)
    force = built * mu(np.where(v == 0, top, v)) * LOAD * pressed
    force = force + zero(share) + noise * rng.standard_normal(v.size)
    normal = LOAD * pressed + normal_zero(share) + noise * rng.standard_normal(v.size)
    return xr.Dataset(
        {
            "sliding_velocity": ("time", v + 1e-4 * top * rng.standard_normal(v.size)),
            "friction_force": ("time", force),
            "normal_force": ("time", normal),
        },
        {"time": time},
        attrs={"source": "made.csv"},
    )


def analysed(run, **options):
    return friction_coefficient(run, find_segments(run), **options)


def off(friction, truth=MU):
    """Error of each coefficient in standard errors."""
    return (friction["friction_coefficient"] - truth) / friction["friction_coefficient_sem"]


def doubts(run, friction, check="zero_reference"):
    found = check_run(run, find_segments(run), friction)
    return [row for row in found.rows if row["check"] == check and row["status"] == "suspect"]


BOTH = [SPEED, -SPEED]
