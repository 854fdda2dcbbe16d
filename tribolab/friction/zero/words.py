"""Texts on the source of a segment's zero, and on doubts about it."""

from __future__ import annotations

import numpy as np

from tribolab.core.wording import many
from tribolab.friction.zero.middles import Middles
from tribolab.friction.zero.parts import Doubt, KnownOfZero, StrokeMeans, doubt
from tribolab.friction.zero.rectified import Fold
from tribolab.friction.zero.rests import LightRest, PartialContact


def words_of(
    strokes: StrokeMeans, loops: Middles, pair: np.ndarray, allowance: np.ndarray, i: int
) -> str:
    """Return the source of the zero of a segment as text."""
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


def of_speeds(
    strokes: StrokeMeans, loops: Middles, known: KnownOfZero, allowance: np.ndarray, measured: bool
) -> list[Doubt]:
    """Return doubts about pairs of unequal speeds whose friction is not known to be equal."""
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
    # if the change with speed was measured, the error includes it; else it is an assumption
    status = "pass" if measured else "suspect"
    return [doubt(text, cure, np.flatnonzero(np.isin(strokes.pair, np.flatnonzero(far))), status)]


def of_fold(fold: Fold, unfolded: bool, size: int) -> tuple[Doubt, ...]:
    """Return the doubt about a lost sign, if any."""
    if fold.kind == "signed" or not fold.why:
        return ()
    done = "the direction of sliding was put back as its sign" if unfolded else "it was left as is"
    cure = (
        "State `rectified = true` if the record holds no sign, `rectified = false` if its offset "
        "is real, for the column in the instrument's file."
    )
    remark = doubt(f"{fold.why}; {done}", cure, np.arange(size))
    remark["check"] = "rectified"
    return (remark,)


def of_partial_contact(partial: PartialContact, load: float, segments: int) -> Doubt:
    """Return the doubt about rests in which the load cell reads more than in the unloaded rest."""
    share = partial.level / load
    text = (
        f"{many(partial.rests, 'rest')} from t = {partial.start:.4g} s on read {partial.level:.3g} "
        f"N ({share:.1%} of the load) more than the unloaded one: contact was not quite lost "
        "there, and they were not taken for the zero of the load. If the zero of the cell moved "
        f"instead, the friction coefficient is {1 / (1 - share) - 1:.1%} larger"
    )
    cure = "Lift the sample clear at each rest, or measure a rest without load at the end."
    return doubt(text, cure, np.arange(segments))


def of_retained_load(level: float, load: float, segments: int) -> Doubt:
    """Return a note on a zero of the load cell that may include a retained load."""
    text = (
        f"the load cell reads {level:.3g} N ({level / load:.1%} of the load) in the rests without "
        "load. This was taken for its zero. It may also be load that the rests retain: the "
        "uncertainty of the friction coefficient includes both"
    )
    cure = (
        "Tare the load cell, lift the sample clear at the rests, or state `normal_zero` in "
        "[uncertainty]."
    )
    return doubt(text, cure, np.arange(segments), "pass")


def of_leak(leak: float, load: float, which: np.ndarray) -> Doubt:
    """Return the doubt about a load whose reading changes between a loaded rest and sliding."""
    text = (
        f"the load reads {leak:+.3g} N ({leak / load:+.1%}) while sliding compared with the loaded "
        "rest: friction leaks into the load reading, or the load itself changes. If it leaks, the "
        f"friction coefficient is off by {abs(leak) / load:.1%}"
    )
    cure = (
        "Slide both ways at one speed, or calibrate the cross-talk of the load cell and correct "
        "the load."
    )
    return doubt(text, cure, which)


def of_light_rest(rest: LightRest, load: float, segments: int) -> Doubt:
    """Return the doubt about a load whose zero may differ: one rest may be unloaded."""
    share = rest.level / load
    between = f"{rest.start:.4g} s to {rest.stop:.4g} s"
    text = (
        f"at rest from t = {between} the normal force reads {rest.level:.3g} N, {share:.0%} of "
        "what it reads while sliding: a light load, or, if nothing pressed there, the zero of its "
        f"sensor, and the friction coefficient is {1 / (1 - share) - 1:.0%} larger"
    )
    cure = (
        f'If nothing pressed there, state `zero = "{between}"` of the column normal_force in the '
        "dialect; if something did, measure a rest without load."
    )
    return doubt(text, cure, np.arange(segments))
