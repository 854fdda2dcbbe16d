"""Required signals of a run, their units, and their possible ranges."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import shown
from tribolab.core.limit import Limit
from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT, uniform
from tribolab.qc.register import Check, Result, sample_result
from tribolab.qc.run.subject import RunSubject
from tribolab.reading.netcdf.table_schema import load_schema
from tribolab.units.quantities import QUANTITIES

_FRICTION = ("friction_force", "friction_coefficient", "shear_stress")
_SPEED = ("sliding_velocity", "position", "step", "set_speed", "shear_rate")


class Range(NamedTuple):
    """Plausible and possible range of a signal in SI, with the reason for its limits."""

    low: float
    high: float
    lowest: float
    highest: float
    reason: str


@functools.cache
def ranges() -> Mapping[str, Range]:
    """Return the plausible range of each signal of a run, from ``run.schema.json``.

    The ranges are wide: they catch a wrong unit or an error code read as a number, not an unusual
    measurement. `table_schema.validate` uses the same ones.

    Examples
    --------
    >>> ranges()["temperature"].low
    70.0
    """
    limits = {}
    for field in load_schema("run")["fields"]:
        if "reason" not in field:  # time and step numbers have checks of their own
            continue
        believed, possible = field["constraints"], field.get("possible", {})
        limits[field["name"]] = Range(
            float(believed["minimum"]),
            float(believed["maximum"]),
            float(possible.get("minimum", "-inf")),
            float(possible.get("maximum", "inf")),
            field["reason"],
        )
    return limits


def flag_range(values: np.ndarray, limits: Range) -> np.ndarray:
    """Return flags: implausible values are suspect, impossible ones fail.

    Examples
    --------
    >>> flag_range(np.array([293.0, 20.0, -1.0, np.nan]), ranges()["temperature"])
    array([1, 3, 4, 2], dtype=int8)
    """
    if not values.size or (values.min() >= limits.low and values.max() <= limits.high):
        return uniform(values.shape, GOOD)
    flags = np.full(values.shape, GOOD, np.int8)
    flags[(values < limits.low) | (values > limits.high)] = SUSPECT
    flags[(values < limits.lowest) | (values > limits.highest)] = FAIL
    flags[np.isnan(values)] = NOT_EVALUATED
    return flags


def wrong_units(run: xr.Dataset) -> dict[str, str]:
    """Return the variables whose unit is not that of their quantity, with the unit."""
    wrong = {}
    for name, variable in run.variables.items():
        known = QUANTITIES.get(str(name))
        unit = variable.attrs.get("units")
        if known is not None and unit is not None and unit != known.unit:
            wrong[str(name)] = str(unit)
    return wrong


def missing_signals(run: xr.Dataset) -> list[tuple[str, str]]:
    """Return the signals that a friction run needs but this one lacks, each with a remedy."""
    missing = []
    if not any(name in run for name in _FRICTION):
        missing.append(
            (
                "no friction was recorded (none of " + ", ".join(_FRICTION) + ")",
                "If the instrument writes two logs, give both. If this file contains friction, "
                "name its column in the dialect.",
            )
        )
    if not any(name in run for name in _SPEED) and "set_speed_m_s" not in run.attrs:
        text = "the speed is unknown (none of " + ", ".join(_SPEED) + ")"
        cure = "State the speed in the dialect: a column, [speed], or a value 'set_speed'."
        if other := RunAttributes.from_attrs(run.attrs).companion_missing:
            text += f": the companion log {other} does not exist"
            cure = f"Put {other} next to this file, or give both."
        missing.append((text, cure))
    return missing


def tensile_share(normal_force: np.ndarray) -> float:
    """Return the share of the loaded samples with a tensile normal force.

    Samples are loaded if the magnitude exceeds a tenth of the 99th percentile. Adhesion can be
    tensile for a moment, but no run slides under tension.
    """
    known = np.isfinite(normal_force)
    known = normal_force if known.all() else normal_force[known]
    if known.size == 0:
        return 0.0
    some = np.abs(known[:: max(1, known.size // 100_000)])
    threshold = 0.1 * float(np.quantile(some, 0.99))
    pulled = int((normal_force < -threshold).sum())
    count = pulled + int((normal_force > threshold).sum())
    return pulled / count if count else 0.0


def _schema(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    run = subject.run
    results = [Result("suspect", "", text, cure=cure) for text, cure in missing_signals(run)]
    for name, unit in wrong_units(run).items():
        results.append(Result("fail", name, f"{name} is in '{shown(unit)}', not in SI"))
    for name, span in one_by_one(ranges().items()):
        if name not in run:
            continue
        flags = flag_range(run[name].values, span)
        text = f"{{count:value|values}} outside {span.low:g} to {span.high:g}: "
        text += f"{span.reason}; {{where}}"
        results.append(sample_result(name, flags, subject.time, text))
    if "normal_force" in run:
        share = tensile_share(run["normal_force"].values)
        if share > limits["pulled"]:
            text = f"the normal force is negative in {share:.0%} of the loaded samples"
            results.append(Result("fail", "normal_force", text, share))
    return results


SCHEMA_CHECKS = (
    Check(
        "schema",
        0,
        "Do the signals exist, in SI units, and within physical limits?",
        "Correct quantity, unit, sign or scale of the column in the dialect.",
        {"pulled": Limit(0.5, "1", "bodies that are separated most of the time do not slide")},
        _schema,
    ),
)
