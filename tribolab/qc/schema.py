"""What a run has to hold: its signals, their units, and the ranges that physics allows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT
from tribolab.quantities import QUANTITIES

FRICTION = ("friction_force", "friction_coefficient", "shear_stress")
SPEED = ("sliding_velocity", "position", "step", "set_speed", "shear_rate")


class Range(NamedTuple):
    """What is believed, what is possible at all, and why; SI."""

    low: float
    high: float
    lowest: float
    highest: float
    reason: str


_BIG = float("inf")

# Wide on purpose: they catch a wrong unit or an error code that passes for a number, not a bad day.
RANGES: dict[str, Range] = {
    "friction_force": Range(-1e5, 1e5, -1e8, 1e8, "10 t is a big tribometer, 10 kt is none"),
    "normal_force": Range(-1e5, 1e5, -1e8, 1e8, "10 t is a big tribometer, 10 kt is none"),
    "friction_coefficient": Range(-50, 50, -1e4, 1e4, "soft adhesive contacts reach some tens"),
    "sliding_velocity": Range(-100, 100, -3e8, 3e8, "discs reach 100 m/s, nothing passes light"),
    "position": Range(-100, 100, -1e6, 1e6, "100 m is a long track for a position"),
    "temperature": Range(70, 2000, 0, 1e5, "below liquid nitrogen: degrees Celsius taken as K?"),
    "normal_stress": Range(-1e11, 1e11, -1e13, 1e13, "no solid bears 100 GPa"),
    "shear_stress": Range(-1e11, 1e11, -1e13, 1e13, "no solid bears 100 GPa"),
    "film_thickness": Range(-1e-3, 1e-2, -1, 1, "films are thinner than a centimetre"),
    "set_speed": Range(-100, 100, -3e8, 3e8, "discs reach 100 m/s, nothing passes light"),
}


def in_range(values: np.ndarray, limits: Range) -> np.ndarray:
    """Flag values outside what is believed (suspect) and outside what is possible (fail).

    Examples
    --------
    >>> in_range(np.array([293.0, 20.0, -1.0, np.nan]), RANGES["temperature"])
    array([1, 3, 4, 2], dtype=int8)
    """
    flags = np.full(values.shape, GOOD, np.int8)
    if values.size and not (values.min() >= limits.low and values.max() <= limits.high):
        flags[(values < limits.low) | (values > limits.high)] = SUSPECT
        flags[(values < limits.lowest) | (values > limits.highest)] = FAIL
        flags[np.isnan(values)] = NOT_EVALUATED
    return flags


def wrong_units(run: xr.Dataset) -> dict[str, str]:
    """Variables whose unit is not the one of the dictionary of quantities, and that unit."""
    found = {}
    for name, variable in run.variables.items():
        known = QUANTITIES.get(str(name))
        unit = variable.attrs.get("units")
        if known is not None and unit is not None and unit != known.unit:
            found[str(name)] = str(unit)
    return found


def lacks(run: xr.Dataset) -> list[tuple[str, str]]:
    """Say what a friction run needs and this one has not, and the cure of each."""
    missing = []
    if not any(name in run for name in FRICTION):
        missing.append(
            (
                "no friction was recorded (none of " + ", ".join(FRICTION) + ")",
                "Give the log of the forces with this one if the instrument writes two; if the "
                "file holds friction, let the dialect name its column.",
            )
        )
    if not any(name in run for name in SPEED) and "set_speed_m_s" not in run.attrs:
        text = "nothing tells the speed (none of " + ", ".join(SPEED) + ")"
        cure = "Let the dialect say the speed: a column, [speed], or a value 'set_speed'."
        if "companion_missing" in run.attrs:
            other = run.attrs["companion_missing"]
            text += f": the companion log {other} is not there"
            cure = f"Put {other} beside this file, or give both."
        missing.append((text, cure))
    return missing


def pulled(normal_force: np.ndarray) -> float:
    """Share of the loaded samples whose normal force says that the bodies are pulled apart.

    Loaded is where its magnitude is above a tenth of the largest (99th percentile); adhesion may
    pull for a moment, but no run slides so.
    """
    size = np.abs(normal_force[np.isfinite(normal_force)])
    if size.size == 0:
        return 0.0
    threshold = 0.1 * float(np.quantile(size[:: max(1, size.size // 100_000)], 0.99))
    loaded = np.abs(normal_force) > threshold
    count = int(loaded.sum())
    return float((normal_force < -threshold).sum() / count) if count else 0.0
