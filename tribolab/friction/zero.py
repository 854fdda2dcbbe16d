"""What the zero of the friction force rests on, for each segment, and what is in doubt about it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tribolab.errors import AnalysisError
from tribolab.friction.middles import Middles, error_of_rows, interpolated, middles
from tribolab.friction.rectified import Fold
from tribolab.friction.rests import Zeros
from tribolab.friction.unequal import across_speeds

ASYMMETRY = 0.05  # share of friction by which a zero may miss the middle of the loop
MISSED = 3.0  # standard errors of the same


@dataclass(frozen=True)
class Strokes:
    """What a zero is sought from: one entry for each segment.

    Parameters
    ----------
    mean, error
        Mean force and its standard error, in the unit u of the signal.
    load
        Mean normal force [N], or one for all where it is not known.
    sign
        Direction.
    speed, time
        Sliding speed [m/s] and middle [s].
    pair
        Number of the pair, -1 for none.
    number
        What each segment is called.
    unit
        The unit u, as text that follows a number.
    """

    mean: np.ndarray
    error: np.ndarray
    load: np.ndarray
    sign: np.ndarray
    speed: np.ndarray
    time: np.ndarray
    pair: np.ndarray
    number: np.ndarray
    unit: str = " N"

    @property
    def size(self) -> int:
        """Number of segments."""
        return self.mean.size


@dataclass(frozen=True)
class Known:
    """What is known of the zero besides the strokes.

    Parameters
    ----------
    rests
        Zeros from rests without load, of a signal that has its sign.
    stated
        Standard uncertainty of a zero that was set to zero, as somebody stated [u], or NaN.
    others
        Zeros of other runs on the same instrument [u].
    tolerance
        Relative difference of speed up to which somebody says that friction is alike.
    """

    rests: Zeros | None = None
    stated: float = float("nan")
    others: tuple[float, ...] = ()
    tolerance: float = 0.25


@dataclass(frozen=True)
class Reference:
    """The zero of each segment and what it rests on.

    Parameters
    ----------
    value
        Zero of each segment at its middle [u] (segment).
    slope
        Its drift [u/s] (segment).
    error
        Function: own errors of the strokes -> errors of their forces without the zero (segment).
    zero_from
        What it rests on, in words (segment).
    half_loop
        Half the loop of each stroke's pair, its zero's drift taken out [u]; NaN without a pair.
    method
        One word for all: "half loop", "zero load", "stated", "other runs", "none: ...".
    doubts
        What is not sure: dictionaries with "check", "message", "cure", "segments" and "status".
    """

    value: np.ndarray
    slope: np.ndarray
    error: Callable[[np.ndarray], np.ndarray]
    zero_from: np.ndarray
    half_loop: np.ndarray
    method: str
    doubts: tuple[dict[str, Any], ...] = field(default=())


def find_reference(strokes: Strokes, known: Known, wanted: str, fold: Fold, name: str) -> Reference:
    """Decide what the zero of each segment rests on.

    Parameters
    ----------
    strokes
        Mean force of each segment; of a force that lost its sign, with the sign put back.
    known
        What else is known.
    wanted
        "auto", "half loop", "zero load" or "none".
    fold
        Whether the sign was lost.
    name
        What the run is called in errors.

    Returns
    -------
    Reference
        With "auto": the middles of the loops where strokes pair; rests without load where they
        do not, or where they contradict the middles; else a stated uncertainty of the zero; else
        the zeros of other runs; else nothing, and that is a doubt.

    Raises
    ------
    AnalysisError
        If the zero that is wanted cannot be had.
    """
    loops = middles(strokes.mean, strokes.load, strokes.sign, strokes.pair, strokes.time)
    found = loops is not None and bool(np.isfinite(loops.value).any())
    if wanted == "half loop" and not found:
        raise AnalysisError(
            f"{name}: offset 'half loop' needs two neighbouring strokes of one speed and opposite"
            " direction, and there are none; use offset='auto', or widen pair_tolerance"
        )
    if wanted == "zero load" and known.rests is None:
        raise AnalysisError(
            f"{name}: offset 'zero load' needs a rest without load, and there is none (or no"
            " velocity or normal force that would show it); use offset='auto'"
        )
    nothing = np.full(strokes.size, np.nan)
    if not strokes.size:
        return _constant(strokes, 0.0, 0.0, "", "none: no segment")
    if found:
        loop = _from_loops(strokes, known, loops)
        nothing = loop.half_loop
    if wanted == "none":
        result = _constant(strokes, 0.0, 0.0, "not wanted", "none: not wanted")
    elif wanted == "zero load":
        result = _from_rests(strokes, known, known.rests)
    elif found:
        result = loop if wanted == "half loop" else _checked(strokes, known, loops, loop)
    elif known.rests is not None:
        result = _from_rests(strokes, known, known.rests)
    else:
        result = _from_outside(strokes, known, fold)
    return replace(result, half_loop=nothing)


def _constant(strokes: Strokes, value: float, error: float, words: str, method: str) -> Reference:
    size = strokes.size
    return Reference(
        np.full(size, value),
        np.zeros(size),
        lambda own: np.hypot(own, error),
        np.full(size, words, dtype=object),
        np.full(size, np.nan),
        method,
    )


def _from_rests(strokes: Strokes, known: Known, rests: Zeros) -> Reference:
    value, error = rests.at(strokes.time)
    words = "a rest without load"
    if rests.time.size > 1:
        words = f"{rests.time.size} rests without load, interpolated in time"
    lonely = ~rests.around(strokes.time)
    doubts = ()
    if np.isfinite(known.stated):
        error = np.where(lonely, np.hypot(error, known.stated), error)
    elif lonely.any():
        text = (
            "the zero was measured on one side of the strokes only: what it drifted from there is "
            "in the friction and not in its error"
        )
        cure = (
            "Measure a rest without load before and after the strokes; or state `zero_uncertainty` "
            '(e.g. "0.2 N"), by how much the zero drifts, in the [[run]].'
        )
        doubts = (_doubt(text, cure, np.flatnonzero(lonely)),)
    return Reference(
        value,
        rests.slope(strokes.time),
        lambda own: np.hypot(own, error),
        np.full(strokes.size, words, dtype=object),
        np.full(strokes.size, np.nan),
        "zero load",
        doubts,
    )


def _from_loops(strokes: Strokes, known: Known, loops: Middles) -> Reference:
    """Zeros from the middles of the loops; strokes without a partner from rests, if there are."""
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

    words = [_words(strokes, loops, pair, allowance, i) for i in range(strokes.size)]
    words = np.where(by_rest, "rests without load, interpolated in time", words).astype(object)
    doubts = _of_speeds(strokes, loops, known, allowance, measured)
    value = np.where(by_rest, at_rest, value)
    return Reference(value, slope, error, words, half_loop, "half loop", tuple(doubts))


def _words(
    strokes: Strokes, loops: Middles, pair: np.ndarray, allowance: np.ndarray, i: int
) -> str:
    """Say what the zero of a segment rests on."""
    number = strokes.number
    drift = ", drift between the loops taken out" if np.any(loops.slope != 0) else ""
    if pair[i] >= 0:
        member = loops.member[pair[i]]
        partner = int(member[0] if member[1] == i else member[1])
        own, other = strokes.speed[i], strokes.speed[partner]
        text = f"half loop with segment {number[partner]}"
        if np.isfinite(own) and abs(own - other) > 0.05 * own:
            text += f" at {other / own:.3g} of its speed (+-{allowance[pair[i]]:.2g}{strokes.unit})"
        between = np.arange(min(number[i], number[partner]) + 1, max(number[i], number[partner]))
        if between.size:
            text += f", {_listed(between)} between them left out"
        return text + drift
    known = np.flatnonzero(np.isfinite(loops.value))
    order = known[np.argsort(loops.time[known])]
    after = int(np.searchsorted(loops.time[order], strokes.time[i]))
    near = order[max(after - 1, 0) : after + 1]
    named = ("-".join(str(number[s]) for s in sorted(loops.member[p])) for p in near)
    return f"no partner: half loops of segments {' and '.join(named)}{drift}"


def _listed(numbers: np.ndarray) -> str:
    some = f"segment {numbers[0]}" if numbers.size == 1 else f"segments {numbers[0]}-{numbers[-1]}"
    return some


def _of_speeds(
    strokes: Strokes,
    loops: Middles,
    known: Known,
    allowance: np.ndarray,
    measured: bool,
) -> list[dict[str, Any]]:
    """Doubt pairs across speeds that nobody stated to be alike and the run does not measure."""
    speed = strokes.speed[loops.member]
    mean = speed.mean(axis=1)
    apart = np.abs(speed[:, 0] - speed[:, 1])
    far = apart > known.tolerance * mean
    if not far.any():
        return []
    worst = int(np.argmax(np.where(far, apart / mean, 0)))
    slow, fast = np.sort(speed[worst])
    text = (
        f"strokes of {slow:.3g} and {fast:.3g} m/s were taken for one loop; what friction changes "
        f"between these speeds is in the error, with {allowance[worst]:.2g}{strokes.unit}"
    )
    wanted = np.ceil(10 * (apart / mean).max()) / 10
    cure = (
        f"If friction hardly changes between them, say `pair_tolerance = {wanted:.1f}` under "
        "[friction]; else measure both directions at one speed, or a rest without load."
    )
    # what the run measures is in the error; what it does not, is guessed there
    status = "pass" if measured else "suspect"
    return [_doubt(text, cure, np.flatnonzero(np.isin(strokes.pair, np.flatnonzero(far))), status)]


def _checked(strokes: Strokes, known: Known, loops: Middles, loop: Reference) -> Reference:
    """Compare the middles of the loops with a zero that does not rest on them.

    Where the two differ by more than their errors and by more than `ASYMMETRY` of friction,
    friction depends on direction, or the load tilts the zero: the other zero is used, and that is
    a doubt. Where they differ by less, the difference is carried in the error.
    """
    if known.rests is not None:
        other = _from_rests(strokes, known, known.rests)
        value, error = known.rests.at(loops.time)
        by = "the rests without load"
    elif np.isfinite(known.stated):
        other = _from_outside(strokes, known, Fold("signed", ""))
        value, error = np.zeros(loops.time.size), np.full(loops.time.size, known.stated)
        by = "the stated zero"
    else:
        return _ambiguous(strokes, loops, loop)
    apart = loops.value - value
    half = (strokes.mean[loops.member] * (0.5, -0.5)).sum(axis=1)
    own = np.sqrt(((loops.share * strokes.error[loops.member]) ** 2).sum(axis=1))
    fine = np.isfinite(apart + half)
    if not fine.any():
        return loop
    mean, friction = float(np.mean(apart[fine])), float(np.mean(np.abs(half[fine])))
    spread = float(np.std(apart[fine], ddof=1)) if fine.sum() > 1 else 0.0
    of_loops = np.nan_to_num(own[fine]).mean() / np.sqrt(fine.sum())
    limit = MISSED * float(np.hypot(np.hypot(spread, error[fine].mean()), of_loops))
    if not abs(mean) > limit:
        return loop
    share = mean / friction
    if abs(share) < ASYMMETRY:
        carried = abs(mean) / np.sqrt(3)
        return replace(loop, error=lambda errors: np.hypot(loop.error(errors), carried))
    force = (strokes.sign * (strokes.mean - other.value)) / strokes.load
    forward, backward = (float(np.nanmean(force[strokes.sign * s > 0])) for s in (1, -1))
    what, unit = "friction", strokes.unit
    if np.any(strokes.load != 1) or not unit:
        what, unit = "the friction coefficient", ""
    text = (
        f"friction differs between the directions: the middle of the loops lies {mean:+.3g}"
        f"{strokes.unit} ({share:+.1%} of friction) beside {by}, by which {what} is "
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
    doubts = (*loop.doubts, _doubt(text, cure, np.arange(strokes.size)))
    return replace(other, doubts=doubts)


def _ambiguous(strokes: Strokes, loops: Middles, loop: Reference) -> Reference:
    """Say that an offset and an asymmetry look the same where no other zero tells them apart."""
    half = (strokes.mean[loops.member] * (0.5, -0.5)).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.abs(loops.value / half)
    share = float(np.nanmedian(share[np.isfinite(share)])) if np.isfinite(share).any() else 0.0
    text = (
        "no rest without load: friction that depends on direction and an offset cannot be told "
        f"apart. The offset that was removed, {np.nanmedian(loops.value):+.3g}{strokes.unit}, "
    )
    if share < 1:
        text += f"would be {share:.1%} more friction one way and less the other; "
    else:
        text += "is larger than friction; what part of it is an asymmetry is not known; "
    text += "their mean does not change"
    doubt = _doubt(text, "Measure a rest without load.", np.arange(strokes.size), "pass")
    return replace(loop, doubts=(*loop.doubts, doubt | {"noted": ASYMMETRY < share < 1}))


def _from_outside(strokes: Strokes, known: Known, fold: Fold) -> Reference:
    """Zero that the run itself does not tell: stated, from other runs, or nothing."""
    if np.isfinite(known.stated):
        words = f"stated: zero within {known.stated:.3g}{strokes.unit}"
        return _constant(strokes, 0.0, known.stated, words, "stated")
    others = np.asarray(known.others, float)
    if others.size > 1 and fold.kind == "signed":
        # of so few, the next one scatters as Student's t with size - 1 degrees of freedom
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
        "the zero of the friction signal is not known: no strokes both ways at one speed, no rest "
        "without load; its offset is in the friction and not in its error"
    )
    example = "0.2 N" if strokes.unit else "1 %"
    cure = (
        f'State `zero_uncertainty` (e.g. "{example}") in the [[run]], or of the column in the '
        "dialect; or measure strokes both ways, or a rest without load."
    )
    return replace(result, doubts=(_doubt(text, cure, np.arange(strokes.size)),))


def _doubt(text: str, cure: str, which: np.ndarray, status: str = "suspect") -> dict[str, Any]:
    return {
        "check": "zero_reference",
        "status": status,
        "message": text,
        "cure": cure,
        "segments": [int(i) for i in which],
        "noted": status == "pass",
    }


def of_fold(fold: Fold, unfolded: bool, size: int) -> tuple[dict[str, Any], ...]:
    """Return the doubt about a sign that was lost, if there is one."""
    if fold.kind == "signed" or not fold.why:
        return ()
    done = "the direction of sliding was put back as its sign" if unfolded else "it was left as is"
    cure = (
        "State `rectified = true` if the record holds no sign, `rectified = false` if its offset "
        "is real: in the [[run]], or of the column in the dialect."
    )
    doubt = _doubt(f"{fold.why}; {done}", cure, np.arange(size))
    return (doubt | {"check": "rectified"},)
