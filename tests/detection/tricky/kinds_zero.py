"""Tricky zeros: rectified signals, friction that depends on the way, drifts, no reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.lab import draw_lab, draw_law, record
from tricky.motion import Leg, rest, strokes
from tricky.trial import Trial, tricky

FORCES = ("friction_force", "normal_force")


def _size(rng, low, high):
    """A number of either sign whose size lies between the two."""
    return float(rng.choice([-1, 1]) * rng.uniform(low, high))


@tricky("8")
def rectified_force(rng) -> Trial:
    """The amplifier takes the absolute value of the friction force; the speed is signed."""
    lab = draw_lab(rng)
    duration = rng.uniform(3, 60)
    pause = float(rng.choice([0.0, 0.0, 2.0]))
    legs = [rest(5.0, float(rng.integers(2))), rest(2.0)]
    legs += strokes(lab.speed * rng.uniform(0.5, 5, 3), duration, pause) + [rest(2.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(500, 3000) / duration)
    run = made.dataset()
    return Trial(run.assign(friction_force=abs(run.friction_force)), made.truth)


@tricky("8")
def rectified_with_offset(rng) -> Trial:
    """As before, but the zero was off before the absolute value was taken."""
    lab = draw_lab(rng)
    duration = rng.uniform(3, 60)
    legs = [rest(5.0, 0.0), rest(2.0)]
    legs += strokes([lab.speed, 2.5 * lab.speed], duration, 1.0) * 2
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 3000) / duration,
        offset=_size(rng, 0.05, 0.4),
    )
    run = made.dataset()
    return Trial(run.assign(friction_force=abs(run.friction_force)), made.truth)


@tricky("8")
def both_without_sign(rng) -> Trial:
    """Friction force and speed are both recorded without sign."""
    lab = draw_lab(rng)
    duration = rng.uniform(3, 60)
    legs = [rest(5.0, float(rng.integers(2))), rest(2.0)]
    legs += strokes(lab.speed * rng.uniform(0.5, 5, 3), duration, 1.0) + [rest(2.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 3000) / duration,
        offset=float(rng.choice([0.0, 0.3])),
    )
    run = made.dataset()
    run = run.assign({n: abs(run[n]) for n in ("friction_force", "sliding_velocity")})
    truth = replace(made.truth, speed=abs(made.truth.speed))
    return Trial(run, truth)


@tricky("8")
def speed_without_sign(rng) -> Trial:
    """The force is signed, the tachometer knows no way."""
    lab = draw_lab(rng)
    duration = rng.uniform(3, 60)
    legs = [rest(5.0, float(rng.integers(2))), rest(2.0)]
    legs += strokes(lab.speed * rng.uniform(0.5, 5, 3), duration, 1.0) + [rest(2.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 3000) / duration,
        offset=_size(rng, 0.1, 0.4),
    )
    run = made.dataset()
    run = run.assign(sliding_velocity=abs(run.sliding_velocity))
    return Trial(run, made.truth)


@tricky("9")
def two_ways_with_zero(rng) -> Trial:
    """Friction differs between the ways, and unloaded rests show the zero."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 60)
    law = draw_law(rng, lab, backward=rng.uniform(0.5, 0.85))
    legs = [rest(10.0, 0.0), rest(3.0), *strokes([lab.speed, 3 * lab.speed], duration, 1.0)]
    legs += [rest(3.0), rest(10.0, 0.0)]
    made = record(
        rng,
        lab,
        legs,
        law,
        rate=rng.uniform(800, 3000) / duration,
        offset=float(rng.choice([0.0, _size(rng, 0.1, 0.45)])),
    )
    return Trial(made.dataset(), made.truth)


@tricky("9")
def two_ways_without_zero(rng) -> Trial:
    """Friction differs between the ways, and nothing shows the zero: the mean of both counts."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 60)
    law = draw_law(rng, lab, backward=rng.uniform(0.6, 0.9))
    legs = [rest(4.0), *strokes([lab.speed, 3 * lab.speed], duration, 1.0), rest(3.0)]
    made = record(rng, lab, legs, law, rate=rng.uniform(800, 3000) / duration)
    return Trial(made.dataset(), made.truth, pair_truth=True)


@tricky("10")
def no_reference(rng) -> Trial:
    """One way, only loaded rests, and a zero that is off."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 100)
    legs = [rest(5.0), *strokes(lab.speed * rng.uniform(0.3, 3, 4), duration, 2.0, (1,))]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0.02, 0.6),
    )
    return Trial(made.dataset(), made.truth)


@tricky("10")
def no_reference_at_all(rng) -> Trial:
    """The record begins and ends while it slides one way; the zero is off."""
    lab = draw_lab(rng)
    duration = rng.uniform(20, 300)
    legs = [Leg(lab.speed, duration)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 5000) / duration,
        offset=_size(rng, 0.02, 0.6),
    )
    names = [(*FORCES, "position"), ()][rng.integers(2)]
    return Trial(made.dataset(*names), made.truth)


@tricky("11")
def drift_between_pairs(rng) -> Trial:
    """The zero of the friction force drifts by one to five times the friction over six pairs."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    total = _size(rng, 0.1, 0.6) * float(rng.choice([1, 1, 8]))
    bend = float(rng.choice([0.0, 0.0, 3.0]))
    shape = (lambda u: total * u) if not bend else (lambda u: total * (1 - np.exp(-bend * u)))
    pause = float(rng.choice([0.0, 2.0]))
    legs = [rest(4.0), *strokes([lab.speed] * 6, duration, pause), rest(4.0)]
    made = record(
        rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(400, 2000) / duration, drift=shape
    )
    return Trial(made.dataset(), made.truth)


@tricky("11")
def drift_one_way(rng) -> Trial:
    """One way between two unloaded rests, and the zero of the friction force drifts."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 100)
    total = _size(rng, 0.03, 0.3) * float(rng.choice([1, 1, 6]))
    legs = [rest(15.0, 0.0), rest(3.0)]
    for factor in (1.0, 2.0, 0.7, 1.4):
        legs += [Leg(lab.speed * factor, duration), rest(3.0), rest(15.0, 0.0), rest(3.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0, 0.4),
        drift=lambda u: total * u,
    )
    return Trial(made.dataset(), made.truth)


@tricky("11")
def normal_zero_drift(rng) -> Trial:
    """The zero of the normal force drifts; unloaded rests between the pairs show it."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 60)
    total = _size(rng, 0.02, 0.2)
    legs = [rest(15.0, 0.0), rest(3.0)]
    for _ in range(int(rng.integers(2, 5))):
        legs += [*strokes([lab.speed], duration, 1.0), rest(15.0, 0.0), rest(3.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0, 0.4),
        normal_offset=_size(rng, 0, 0.1),
        normal_drift=lambda u: total * u,
    )
    return Trial(made.dataset(), made.truth)


@tricky("12")
def unequal_strokes(rng) -> Trial:
    """Forward and backward at speeds that differ by a factor of 1.5 to 2.5, with an offset."""
    lab = draw_lab(rng)
    law = draw_law(rng, lab)
    if rng.random() < 0.6:
        law = replace(law, slope=0.0, stribeck=0.0)
    factor = rng.uniform(1.5, 2.5)
    duration = rng.uniform(4, 40)
    legs = [rest(4.0)]
    for _ in range(int(rng.integers(3, 7))):
        legs += [Leg(lab.speed, duration), Leg(-factor * lab.speed, duration / factor)]
    made = record(
        rng,
        lab,
        legs + [rest(3.0)],
        law,
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0.1, 0.45) * float(rng.choice([1, 1, 20])),
    )
    names = [(*FORCES, "position"), ()][rng.integers(2)]
    return Trial(made.dataset(*names), made.truth)


@tricky("13")
def taken_out_by_hand(rng) -> Trial:
    """The user takes a stroke out; what is left of its pair has neighbours of its speed."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    total = _size(rng, 0.05, 0.4)
    legs = [rest(5.0), *strokes([lab.speed] * 3, duration, 1.0), rest(3.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0.1, 0.45),
        drift=lambda u: total * u,
    )
    return Trial(made.dataset(), made.truth, drop=(int(rng.integers(6)),))


@tricky("10")
def ring_way_up_and_down(rng) -> Trial:
    """Speeds up and down again, one way, after an unloaded rest; offset and drift are small."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    speeds = lab.speed * np.concatenate([np.geomspace(1, 30, 5), np.geomspace(30, 1, 5)[1:]])
    total = _size(rng, 0.0, 0.3)
    legs = [rest(12.0, 0.0), rest(3.0), *strokes(speeds, duration, 0.0, (1,))]
    legs += [rest(3.0), rest(12.0, 0.0) if rng.random() < 0.5 else rest(12.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0, 0.45),
        drift=lambda u: total * u,
    )
    return Trial(made.dataset(), made.truth)


@tricky("11")
def zero_jump(rng) -> Trial:
    """The zero of the friction force jumps once in mid-run, between two strokes or within one."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    size, at = _size(rng, 0.05, 0.5), rng.uniform(0.2, 0.8)
    legs = [rest(4.0), *strokes([lab.speed] * int(rng.integers(3, 8)), duration, 1.0), rest(4.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(400, 2000) / duration,
        drift=lambda u: size * (u > at),
    )
    return Trial(made.dataset(), made.truth)


@tricky("11")
def wandering_zero(rng) -> Trial:
    """The zero wanders like the air of the room: a slow wave over the run, pairs in between."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    size, waves, phase = rng.uniform(0.05, 0.4), rng.uniform(0.5, 3), rng.uniform(0, 6.28)
    legs = [rest(4.0), *strokes([lab.speed] * 8, duration, 1.0), rest(4.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(400, 2000) / duration,
        drift=lambda u: size * np.sin(6.28 * waves * u + phase),
    )
    return Trial(made.dataset(), made.truth)


@tricky("9")
def load_depends_on_way(rng) -> Trial:
    """The slider dives: the normal force, recorded as it is, is 5 to 30 % larger forward."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 60)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed, 3 * lab.speed], duration, 1.0)]
    made = record(
        rng,
        lab,
        legs + [rest(8.0, 0.0)],
        draw_law(rng, lab),
        rate=rng.uniform(800, 3000) / duration,
        offset=_size(rng, 0.1, 0.4),
        tilt=_size(rng, 0.05, 0.3),
    )
    return Trial(made.dataset(), made.truth)


@tricky("11")
def load_steps(rng) -> Trial:
    """Other loads from pair to pair, an offset, and no unloaded rest."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    legs = [rest(4.0)]
    for share in rng.permutation([1.0, 0.85, 0.7, 0.55]):
        legs += [rest(4.0, share), Leg(lab.speed, duration, share), rest(1.0, share)]
        legs += [Leg(-lab.speed, duration, share), rest(1.0, share)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 2000) / duration,
        offset=_size(rng, 0.1, 0.4),
    )
    return Trial(made.dataset(), made.truth)


@tricky("8")
def ratio_without_sign(rng) -> Trial:
    """The instrument gives the coefficient alone, without sign; a zero that is off is in it."""
    lab = draw_lab(rng)
    duration = rng.uniform(3, 60)
    legs = [rest(2.0), *strokes([lab.speed, 2.5 * lab.speed], duration, 1.0) * 2, rest(2.0)]
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(500, 3000) / duration,
        offset=float(rng.choice([0.0, _size(rng, 0.03, 0.4)])),
    )
    run = made.dataset()
    ratio = abs(run.friction_force / run.normal_force).assign_attrs(units="1")
    run = run.drop_vars(["friction_force", "normal_force"]).assign(friction_coefficient=ratio)
    if rng.integers(2):
        run = run.assign(sliding_velocity=abs(run.sliding_velocity))
        return Trial(run, replace(made.truth, speed=abs(made.truth.speed)))
    return Trial(run, made.truth)
