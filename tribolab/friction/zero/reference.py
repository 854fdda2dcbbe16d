"""Choice of the source of the zero of the friction force for each segment, with doubts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribolab.arrays.medians import median, median_of_known
from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.zero import limits
from tribolab.friction.zero.middles import Middles, error_of_rows, interpolated, middles
from tribolab.friction.zero.parts import Doubt, KnownOfZero, StrokeMeans, ZeroReference, doubt
from tribolab.friction.zero.rectified import Fold
from tribolab.friction.zero.rests import Zeros
from tribolab.friction.zero.unequal import across_speeds
from tribolab.friction.zero.words import of_speeds, words_of

_OFFSET_OF_ITSELF = 'say offset = "auto" in [friction]'


def find_reference(
    strokes: StrokeMeans, known: KnownOfZero, wanted: str, fold: Fold, name: str
) -> ZeroReference:
    """Return the zero of each segment and its source.

    Parameters
    ----------
    strokes
        Mean force of each segment, with the sign restored if it was lost.
    known
        Other information on the zero.
    wanted
        "auto", "half loop", "zero load" or "none".
    fold
        Whether the sign was lost.
    name
        Name of the run in errors.

    Returns
    -------
    ZeroReference
        With "auto": the middles of the loops if strokes pair; unloaded rests if strokes do not
        pair, or if rests contradict the middles; else a stated uncertainty of the zero; else a zero
        that was read at one place, with a doubt; else the zeros of other runs; else none, with a
        doubt.

    Raises
    ------
    AnalysisError
        If the requested zero cannot be determined.
    """
    loops = middles(strokes.mean, strokes.load, strokes.sign, strokes.pair, strokes.time)
    if loops is not None and not np.isfinite(loops.value).any():
        loops = None
    if wanted == "half loop" and loops is None:
        raise AnalysisError(
            "offset 'half loop' needs two neighbouring strokes of one speed and opposite direction,"
            " which the run lacks",
            where=name,
            cure=Cure(
                notebook="use offset='auto', or widen pair_tolerance",
                campaign=f"{_OFFSET_OF_ITSELF}, or widen pair_tolerance there",
            ),
        )
    if wanted == "zero load" and known.rests is None:
        raise AnalysisError(
            "offset 'zero load' needs a rest without load, which the run lacks (or a velocity or"
            " normal force to show it)",
            where=name,
            cure=Cure(notebook="use offset='auto'", campaign=_OFFSET_OF_ITSELF),
        )
    nothing = np.full(strokes.size, np.nan)
    if not strokes.size:
        return _constant(strokes, 0.0, 0.0, "", "none: no segment")
    if loops is not None:
        loop = _loop_zeros(strokes, known, _correct_tilt(strokes, known.rests, loops))
        nothing = loop.half_loop
    if wanted == "none":
        result = _constant(strokes, 0.0, 0.0, "not wanted", "none: not wanted")
    elif wanted == "zero load" and known.rests is not None:
        result = _rest_zeros(strokes, known, known.rests)
    elif loops is not None:
        result = loop if wanted == "half loop" else _compare(strokes, known, loops, loop, fold)
    elif known.rests is not None:
        result = _rest_zeros(strokes, known, known.rests)
    else:
        result = _outside_zero(strokes, known, fold)
    return replace(result, half_loop=nothing)


def _correct_tilt(strokes: StrokeMeans, rests: Zeros | None, loops: Middles) -> Middles:
    """Return the middles of the loops corrected for tilt, if they then agree better.

    With a tilt the load reading is too low in one direction and too high in the other, in
    proportion to friction. Middles weighted with such loads vary with friction, like a drifting
    zero. Unloaded rests determine the tilt. Cross-talk shifts the middles in the same way, but not
    the loads. Therefore those loads are used, corrected or not, for which the middles agree better.
    """
    if rests is None or not np.isfinite(loops.value).sum() > 1:
        return loops
    force = strokes.mean - rests.at(strokes.time)[0]
    angle = np.arctan2(force, strokes.load)[loops.member].mean(axis=1)
    tilt = float(median_of_known(angle))
    load = strokes.load * np.cos(tilt) + force * np.sin(tilt)
    turned = middles(strokes.mean, load, strokes.sign, strokes.pair, strokes.time)
    if turned is None:
        return loops
    apart = [np.nanstd(some.value - rests.at(some.time)[0]) for some in (loops, turned)]
    return turned if apart[1] < apart[0] else loops


def _constant(
    strokes: StrokeMeans, value: float, error: float, words: str, method: str
) -> ZeroReference:
    size = strokes.size
    return ZeroReference(
        np.full(size, value),
        np.zeros(size),
        lambda own: np.hypot(own, error),
        np.full(size, words, dtype=object),
        np.full(size, np.nan),
        method,
    )


def _rest_zeros(strokes: StrokeMeans, known: KnownOfZero, rests: Zeros) -> ZeroReference:
    value, error = rests.at(strokes.time)
    words = "a rest without load"
    if rests.time.size > 1:
        words = f"{rests.time.size} rests without load, interpolated in time"
    lonely = ~rests.around(strokes.time)
    doubts: tuple[Doubt, ...] = ()
    if np.isfinite(known.stated):
        error = np.where(lonely, np.hypot(error, known.stated), error)
    elif lonely.any():
        text = (
            "the zero was measured before or after the sliding only: what it drifted from there is "
            "in the friction and not in its error"
        )
        cure = (
            "Measure a rest without load before and after the sliding; or state `zero_uncertainty` "
            '(e.g. "0.2 N"), by how much the zero drifts, in the [[run]].'
        )
        doubts = (doubt(text, cure, np.flatnonzero(lonely)),)
    return ZeroReference(
        value,
        rests.slope(strokes.time),
        lambda own: np.hypot(own, error),
        np.full(strokes.size, words, dtype=object),
        np.full(strokes.size, np.nan),
        "zero load",
        doubts,
    )


def _loop_zeros(strokes: StrokeMeans, known: KnownOfZero, loops: Middles) -> ZeroReference:
    """Return zeros from the middles of the loops; for strokes without a partner, from rests."""
    good = np.isfinite(loops.value)
    pair = np.where((strokes.pair >= 0) & good[strokes.pair.clip(0)], strokes.pair, -1)
    paired = pair >= 0
    value, slope, rows = interpolated(loops, pair, strokes.time)
    forward, backward = loops.member.T
    half = (strokes.mean[forward] - strokes.mean[backward]) / 2
    half -= loops.slope * (strokes.time[forward] - strokes.time[backward]) / 2
    half_loop = np.where(paired, half[pair.clip(0)], np.nan)
    speeds = strokes.speed[loops.member]
    allowance, measured = across_speeds(half, speeds)
    extra = np.where(paired, allowance[pair.clip(0)], np.nanmax(allowance, initial=0.0))
    extra = np.nan_to_num(extra)
    at_rest, rest_error = np.zeros(strokes.size), np.zeros(strokes.size)
    by_rest = np.zeros(strokes.size, dtype=bool)
    if known.rests is not None:
        at_rest, rest_error = known.rests.at(strokes.time)
        by_rest = ~paired & known.rests.around(strokes.time)
        slope = np.where(by_rest, known.rests.slope(strokes.time), slope)

    def error(own: np.ndarray) -> np.ndarray:
        of_loops = np.hypot(error_of_rows(rows, loops, own, strokes.time), extra)
        return np.where(by_rest, np.hypot(own, rest_error), of_loops)

    own = [words_of(strokes, loops, pair, allowance, i) for i in range(strokes.size)]
    words = np.where(by_rest, "rests without load, interpolated in time", own).astype(object)
    doubts = of_speeds(strokes, loops, known, allowance, measured)
    value = np.where(by_rest, at_rest, value)
    return ZeroReference(value, slope, error, words, half_loop, "half loop", tuple(doubts))


def _compare(
    strokes: StrokeMeans, known: KnownOfZero, loops: Middles, loop: ZeroReference, fold: Fold
) -> ZeroReference:
    """Return the zero after comparing the middles of the loops with an independent zero.

    If the two differ by more than their errors and by more than `MAX_ASYMMETRY` of friction,
    friction depends on direction, or the load tilts the zero: the other zero is used, with a doubt.
    A smaller difference is included in the error.
    """
    if known.rests is not None:
        other = _rest_zeros(strokes, known, known.rests)
        value, error = known.rests.at(loops.time)
        by = "the rests without load"
    elif np.isfinite(known.stated):
        other = _outside_zero(strokes, known, Fold("signed", ""))
        value, error = np.zeros(loops.time.size), np.full(loops.time.size, known.stated)
        by = "the stated zero"
    else:
        return _doubt_asymmetry(strokes, loops, loop, fold)
    apart = loops.value - value
    half = (strokes.mean[loops.member] * (0.5, -0.5)).sum(axis=1)
    own = np.sqrt(((loops.share * strokes.error[loops.member]) ** 2).sum(axis=1))
    fine = np.isfinite(apart + half)
    if not fine.any():
        return loop
    mean, friction = float(np.mean(apart[fine])), float(np.mean(np.abs(half[fine])))
    spread = float(np.std(apart[fine], ddof=1)) if fine.sum() > 1 else 0.0
    of_loops = np.nan_to_num(own[fine]).mean() / np.sqrt(fine.sum())
    limit = limits.MIN_ERRORS_OF_ASYMMETRY.value * float(
        np.hypot(np.hypot(spread, error[fine].mean()), of_loops)
    )
    if not abs(mean) > limit:
        return loop
    share = mean / friction
    if abs(share) < limits.MAX_ASYMMETRY.value:
        carried = abs(mean) / np.sqrt(3)
        return replace(loop, error=lambda errors: np.hypot(loop.error(errors), carried))
    force = (strokes.sign * (strokes.mean - other.value)) / strokes.load
    forward, backward = (float(np.nanmean(force[strokes.sign * s > 0])) for s in (1, -1))
    what, unit = "friction", strokes.unit
    if np.any(strokes.load != 1) or not unit:
        what, unit = "the friction coefficient", ""
    text = (
        f"friction differs between the directions: the middle of the loops lies {mean:+.3g}"
        f"{strokes.unit} ({share:+.1%} of friction) from {by}, by which {what} is "
        f"{forward:.3g}{unit} forward and {backward:.3g}{unit} backward; that zero was used"
    )
    cure = (
        'If friction depends on direction, say `offset = "zero load"` under [friction]; if the '
        'load moves the zero (a tilted or cross-talking cell), say `offset = "half loop"`.'
    )
    if by == "the stated zero":
        cure = (
            'If friction does not depend on direction, say `offset = "half loop"` under '
            "[friction]; else measure a rest without load."
        )
    doubts = (*loop.doubts, doubt(text, cure, np.arange(strokes.size)))
    return replace(other, doubts=doubts)


def _doubt_asymmetry(
    strokes: StrokeMeans, loops: Middles, loop: ZeroReference, fold: Fold
) -> ZeroReference:
    """Return the zero with a doubt: the offset may be friction that depends on direction."""
    half = (strokes.mean[loops.member] * (0.5, -0.5)).sum(axis=1)
    offset, usual = median_of_known(loops.value), median_of_known(np.abs(half))
    share = float(abs(offset) / usual) if usual > 0 and np.isfinite(offset) else 0.0
    text = (
        "no rest without load: friction that depends on direction and an offset look "
        f"alike. The offset that was removed, {offset:+.3g}{strokes.unit}, "
    )
    cure, status = "Measure a rest without load.", "pass"
    if share < 1:
        text += f"would be {share:.1%} more friction one way and less the other; "
        text += "their mean does not change"
    elif fold.seen:
        text += "is larger than friction; what part of it is an asymmetry is not known; "
        text += "their mean does not change"
    else:
        text += (
            "is larger than the friction that is left. If the signal lost its sign, friction is "
            f"about {offset:.3g}{strokes.unit}"
        )
        cure = "State `rectified` in the [[run]], or measure a rest without load."
        status = "suspect"
    remark = doubt(text, cure, np.arange(strokes.size), status)
    remark["noted"] = bool(limits.MAX_ASYMMETRY.value < share < 1)
    return replace(loop, doubts=(*loop.doubts, remark))


def _outside_zero(strokes: StrokeMeans, known: KnownOfZero, fold: Fold) -> ZeroReference:
    """Return the zero that is known from outside the run: stated, of other runs, or none."""
    if np.isfinite(known.stated):
        words = f"stated: zero within {known.stated:.3g}{strokes.unit}"
        if known.read_from:
            words += f", read from {known.read_from}"
        error = float(np.hypot(known.stated, np.nan_to_num(known.read)))
        return replace(_constant(strokes, 0.0, error, words, "stated"), stated=error)
    if known.read_from:
        words = f"read from {known.read_from}"
        result = _constant(strokes, 0.0, float(np.nan_to_num(known.read)), words, "read zero")
        text = (
            f"the zero was read from {known.read_from} only: what it drifted from there to the "
            "strokes is in the friction and not in its error"
        )
        cure = (
            f'State `zero_uncertainty` (e.g. "{_example(strokes)}"), by how much '
            "the zero drifts, in the [[run]] or of the column in the dialect; or measure strokes "
            "both ways, or rests without load before and after."
        )
        return replace(result, doubts=(doubt(text, cure, np.arange(strokes.size)),))
    others = np.asarray(known.others, float)
    if others.size > 1 and fold.kind == "signed":
        # the zero of the next run deviates from those of few runs by Student's t
        few = (
            np.sqrt((1 + 1 / others.size) * max((others.size - 1) / (others.size - 3), 1.0))
            if (others.size > 3)
            else 3.0
        )
        error = max(few * float(np.std(others, ddof=1)), 1e-3 * float(np.abs(others).max()))
        words = f"zeros of {others.size} other runs on this instrument"
        return _constant(strokes, float(others.mean()), error, words, "other runs")
    result = _constant(
        strokes, 0.0, 0.0, "nothing", "none: no pair of strokes, no rest without load"
    )
    text = (
        "the zero of the friction signal is not known: no strokes in both directions and no rest "
        "without load. Any offset biases µ and is not in its uncertainty"
    )
    example = _example(strokes)
    cure = (
        "Record strokes in both directions, or a rest without load. Or state in campaign.toml how "
        f'far the signal may be from zero without contact (e.g. `zero_uncertainty = "{example}"`).'
    )
    return replace(result, doubts=(doubt(text, cure, np.arange(strokes.size)),))


def _example(strokes: StrokeMeans) -> str:
    """Return an example of a zero uncertainty: a fiftieth of the friction of these strokes."""
    size = np.abs(strokes.mean[np.isfinite(strokes.mean)])
    share = limits.EXAMPLE_OF_ZERO_ERROR.value * float(median(size)) if size.size else 0.0
    if not strokes.unit or not share > 0:
        return "1 %"
    return f"{share:.1g}{strokes.unit}"
