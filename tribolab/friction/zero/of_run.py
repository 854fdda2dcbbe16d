"""Zero of a run's friction signal, from rests, strokes and stated values; lost signs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median, median_of_known
from tribolab.core.attributes import RunAttributes, SegmentAttributes
from tribolab.core.errors import AnalysisError, UnitError, shown
from tribolab.friction.zero import limits
from tribolab.friction.zero.limits import LOADS_DIFFER
from tribolab.friction.zero.offsets import pair_strokes
from tribolab.friction.zero.part_folded import of_parts
from tribolab.friction.zero.parts import KnownOfZero, StrokeMeans, ZeroReference
from tribolab.friction.zero.rectified import SIGNED, Fold, ForceTrace, Pressed, folded
from tribolab.friction.zero.reference import find_reference
from tribolab.friction.zero.rests import Zeros
from tribolab.friction.zero.words import of_fold
from tribolab.units.conversion import to_si
from tribolab.units.quantities import quantity

_FROM_TORQUE = re.compile(r"\s*(?:\w+|\(\w+ - \w+\))\s*/\s*(?:(?P<arm>\w+)|'(?P<length>[^']+)')\s*")
_WITHOUT_SIGN = "mean of both directions: recorded without sign"
# methods that subtract one offset from both strokes of a pair, which then are one observation
PAIRED = ("half loop", _WITHOUT_SIGN)


class StatedZeroError(AnalysisError):
    """Raised if the stated zero uncertainty does not fit the friction signal of the run."""


@dataclass(frozen=True)
class Settings:
    """User settings for the zero.

    Parameters
    ----------
    offset
        "auto", "half loop", "zero load" or "none".
    pair_tolerance
        Largest relative difference of speed between the two strokes of a pair.
    zero_uncertainty
        Standard uncertainty of the friction signal's zero, in its unit or as text with one, which
        may be a torque if the force was computed from torque and lever arm; None: from the run's
        attribute ``<signal>_zero_uncertainty``, if any.
    rectified
        Whether the signal was recorded without sign; None: from the run's attribute
        ``<signal>_rectified`` or from the signal itself.
    other_zeros
        Zeros of other runs on the same instrument, in the unit of the signal.
    """

    offset: str = "auto"
    pair_tolerance: float = 0.25
    zero_uncertainty: str | float | None = None
    rectified: bool | None = None
    other_zeros: Sequence[float] = ()


@dataclass(frozen=True)
class Signs:
    """Direction of each segment, and the factor that puts back a lost sign (segment)."""

    sign: np.ndarray
    unfold: np.ndarray


def zero_of_run(
    run: xr.Dataset,
    segments: xr.Dataset,
    name: str,
    parts: list[slice],
    mean: np.ndarray,
    error: np.ndarray,
    load: np.ndarray,
    middle: np.ndarray,
    rests: Zeros | None,
    settings: Settings,
) -> tuple[ZeroReference, Signs, np.ndarray]:
    """Return the zero of the friction signal of a run, with its source.

    Parameters
    ----------
    run, segments
        The run and its segments.
    name
        The signal: "friction_force" or "friction_coefficient".
    parts
        Samples of each trimmed segment.
    mean, error
        Mean of the signal over each segment, and its standard error (segment).
    load
        Mean normal force of each segment [N], or one for all if unknown (segment).
    middle
        Mean time of the samples of each segment [s] (segment).
    rests
        Zeros from rests without load.
    settings
        User settings.

    Returns
    -------
    tuple
        The reference, the signs, and the number of each segment's pair (segment).
    """
    direction = segments["direction"].values.astype(float)
    sign = np.where(direction != 0, direction, np.where(mean < 0, -1.0, 1.0))
    unfold = np.ones(mean.size)
    stated = _stated(run, name, settings.zero_uncertainty)
    fold = _fold(run, segments, name, parts, mean, error, direction, load, rests, settings)
    if (direction > 0).any() and (direction < 0).any() and _lost(fold):
        unfold = sign * (1.0 if median_of_known(mean) >= 0 else -1.0)
    if fold.kind != "signed" and settings.offset != "zero load":
        rests = None  # a rectified signal shows only the magnitude of the zero
    pair = _pairs(segments, settings, rests, stated)
    unit = quantity(name).unit
    strokes = StrokeMeans(
        mean=unfold * mean,
        error=error,
        load=load,
        sign=sign,
        speed=segments["sliding_speed"].values,
        time=middle,
        pair=pair,
        number=_segment_numbers(segments),
        unit="" if unit == "1" else f" {unit}",
    )
    others = tuple(settings.other_zeros)
    known = KnownOfZero(rests, stated, others, settings.pair_tolerance, *_zero_from_file(run, name))
    source = str(run.attrs.get("source", "run"))
    reference = find_reference(strokes, known, settings.offset, fold, source)
    if _lost(fold):
        words = [f"recorded without sign: {text}" for text in reference.zero_from]
        method = _WITHOUT_SIGN if reference.method == "half loop" else reference.method
        reference = replace(reference, zero_from=np.array(words, dtype=object), method=method)
    parts_of_it = of_parts(strokes) if fold.kind == "signed" and settings.rectified is None else ()
    doubts = (*of_fold(fold, bool((unfold != 1).any()), mean.size), *parts_of_it, *reference.doubts)
    return replace(reference, doubts=doubts), Signs(sign, unfold), pair


def _lost(fold: Fold) -> bool:
    return fold.kind in ("rectified", "undecided: alike")


def _zero_from_file(run: xr.Dataset, name: str) -> tuple[float, str]:
    """Return the error of a zero that was subtracted on reading, and its place in the file."""
    unit = quantity(name).unit
    ending = "" if unit == "1" else f"_{unit}"
    error = float(run.attrs.get(f"{name}_zero_sem{ending}", np.nan))
    about = RunAttributes.from_attrs(run.attrs)
    read, stated = about.zeros_read.get(name, ""), about.zeros_stated.get(name, "")
    return error, read or (f"the text of the file ({stated})" if stated else "")


def _stated(run: xr.Dataset, name: str, given: str | float | None) -> float:
    unit = quantity(name).unit
    if given is None:
        ending = "" if unit == "1" else f"_{unit}"
        return float(run.attrs.get(f"{name}_zero_uncertainty{ending}", np.nan))
    try:
        return abs(to_si(given, unit, name="zero_uncertainty"))
    except UnitError as error:
        torque = _torque(given)
        if torque is not None and unit == "N":
            return torque / _arm(run, name)
        want = 'dimensionless here, e.g. "1 %"' if unit == "1" else 'a force, e.g. "0.2 N"'
        raise StatedZeroError(f"zero_uncertainty must be {want}, not '{shown(given)}'") from error


def _torque(given: str | float) -> float | None:
    try:
        return abs(to_si(given, "N m", name="zero_uncertainty"))
    except UnitError:
        return None


def _arm(run: xr.Dataset, name: str) -> float:
    """Return the lever arm [m] that converted a torque to the friction force."""
    formula = RunAttributes.from_attrs(run.attrs).derived.get(name, "")
    made = _FROM_TORQUE.fullmatch(formula)
    arm = float("nan")
    if made is not None:
        stated = run.attrs.get(f"{made['arm']}_m")
        arm = to_si(made["length"], "m", "arm") if made["length"] else float(stated or "nan")
    if not arm > 0:
        raise AnalysisError(
            "zero_uncertainty is a torque, and the friction force of this run is not a torque over "
            "an arm that is known; state a force, e.g. '0.2 N'",
            where=str(run.attrs.get("source", "run")),
        )
    return arm


def _segment_numbers(segments: xr.Dataset) -> np.ndarray:
    """Return the segment numbers that tables show: from 1, including rejected segments."""
    if "segment" in segments.coords:
        return segments["segment"].values + 1
    return np.arange(segments.sizes["segment"]) + 1


def _pairs(
    segments: xr.Dataset, settings: Settings, rests: Zeros | None, stated: float
) -> np.ndarray:
    """Return pairs of strokes at equal speed, or at any speed if the zero is otherwise unknown."""
    pair = pair_strokes(segments, settings.pair_tolerance)
    wanted = settings.offset == "half loop" or (
        settings.offset == "auto" and rests is None and not np.isfinite(stated)
    )
    if (pair >= 0).any() or not wanted:
        return pair
    return pair_strokes(
        segments, max(limits.MAX_SPEED_RATIO_OF_LOOP.value, settings.pair_tolerance)
    )


def _fold(
    run: xr.Dataset,
    segments: xr.Dataset,
    name: str,
    parts: list[slice],
    mean: np.ndarray,
    error: np.ndarray,
    direction: np.ndarray,
    load: np.ndarray,
    rests: Zeros | None,
    settings: Settings,
) -> Fold:
    stated = settings.rectified
    if stated is None:
        stated = run.attrs.get(f"{name}_rectified")
    if stated is not None:
        return Fold("rectified", "") if stated else SIGNED
    if SegmentAttributes.from_attrs(segments.attrs).velocity_source not in ("recorded", "position"):
        return SIGNED  # the direction is unknown, or was derived from the force
    rest = float(median(rests.value)) if rests is not None else float("nan")
    normal = run["normal_force"].values if "normal_force" in run and parts else None
    pressed = Pressed(normal, parts, max(0.5, limits.MAX_DRIFT_OF_LOAD_ZERO.value))
    force, speed = run[name].values, segments["sliding_speed"].values
    ways = (direction > 0).any() and (direction < 0).any()
    if not ways and load.max(initial=0.0) > LOADS_DIFFER.value * load.min(initial=np.inf):
        return SIGNED  # at load steps the force goes to zero and back, too
    return folded(ForceTrace(force, pressed, parts, mean, error, direction, rest, speed=speed))
