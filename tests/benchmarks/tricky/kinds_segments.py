"""Tricky motions: ramps that look constant, resets, unloaded parts, few samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.lab import draw_lab, draw_law, record
from tricky.motion import Leg, rest, shaped, strokes
from tricky.trial import Trial, Truth, tricky


def _nothing(made, **more) -> Trial:
    """A run that never slides at constant speed."""
    empty = np.array([])
    truth = Truth(empty, empty, empty, made.truth.time, made.truth.mu)
    return Trial(made.dataset(), truth, **more)


@tricky("4")
def triangle(rng) -> Trial:
    """Speed goes up and down again like a triangle, once or in reversals."""
    lab = draw_lab(rng, speed=(1e-4, 1.0))
    ways = [(1,), (1, -1), (1, -1) * 3][rng.integers(3)]
    duration = rng.uniform(4, 60)
    legs = [rest(5.0, 0.0), rest(3.0)]
    legs += [shaped(w * lab.speed, duration, lambda u: 1 - np.abs(2 * u - 1)) for w in ways]
    legs += [rest(5.0)]
    return _nothing(record(rng, lab, legs, draw_law(rng, lab), rate=rng.choice([20, 100, 250])))


@tricky("4")
def crank(rng) -> Trial:
    """A crank drives the stage: the velocity is a sine over many cycles."""
    lab = draw_lab(rng, speed=(1e-3, 1.0))
    cycles = int(rng.integers(3, 20))
    period = rng.uniform(0.5, 10)
    legs = [rest(5.0, 0.0), rest(3.0)]
    legs += [shaped(lab.speed, period * cycles, lambda u: np.sin(2 * np.pi * cycles * u))]
    legs += [rest(3.0)]
    rate = min(2000.0, 60 / period * rng.uniform(1, 5))
    return _nothing(record(rng, lab, legs, draw_law(rng, lab), rate=rate))


@tricky("4")
def trapezoid_triangle(rng) -> Trial:
    """Plateaus both ways, and between them a triangle of the same duration."""
    lab = draw_lab(rng)
    duration = rng.uniform(5, 40)
    hill = shaped(lab.speed * rng.uniform(0.5, 3), duration, lambda u: 1 - np.abs(2 * u - 1))
    legs = [rest(6.0, 0.0), rest(3.0), *strokes([lab.speed], duration, 2.0), hill, rest(3.0)]
    legs += strokes([lab.speed * rng.uniform(1.5, 4)], duration, 2.0)
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(20, 200))
    return Trial(made.dataset(), made.truth)


@tricky("4")
def drooping(rng) -> Trial:
    """A motor that loses 25 to 60 % of its speed over each stroke: a ramp, however slow."""
    lab = draw_lab(rng)
    loss = rng.uniform(0.25, 0.6)
    duration = rng.uniform(10, 80)
    legs = [rest(6.0, 0.0), rest(3.0)]
    for way in (1, -1) * 3:
        legs += [shaped(way * lab.speed, duration, lambda u: 1 - loss * u), rest(2.0)]
    return _nothing(record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(10, 100)))


@tricky("4")
def exponential_sweep(rng) -> Trial:
    """Speed grows by three decades in one go, evenly over its logarithm."""
    lab = draw_lab(rng, speed=(1e-3, 1.0))
    legs = [rest(6.0, 0.0), rest(3.0)]
    legs += [shaped(lab.speed, rng.uniform(30, 200), lambda u: 10 ** (3 * u - 3)), rest(4.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(20, 100))
    return _nothing(made)


@tricky("5")
def reset_sensor(rng) -> Trial:
    """Long holds at constant speed; the displacement sensor is reset in mid-run."""
    lab = draw_lab(rng, speed=(5e-7, 1e-4))
    factors = rng.permutation([1.0, 3.0, 0.3, 10.0])[: rng.integers(2, 5)]
    legs = [rest(30.0, 0.0), rest(20.0)]
    legs += [Leg(lab.speed * f, rng.uniform(200, 1200)) for f in factors] + [rest(30.0, 0.0)]
    law = draw_law(rng, lab, build_up=lab.speed)
    made = record(rng, lab, legs, law, rate=rng.uniform(2, 10), ramp=0.5)
    position = made.position.copy()
    for _ in range(rng.integers(1, 3)):
        at = int(rng.uniform(0.2, 0.8) * position.size)
        position[at:] -= position[at] - made.position[0]
    made = replace(made, position=position)
    return Trial(made.dataset("friction_force", "normal_force", "position"), made.truth)


@tricky("5")
def lifted_in_between(rng) -> Trial:
    """The slider is lifted and carried back without load between holds in one direction."""
    lab = draw_lab(rng)
    duration = rng.uniform(20, 200)
    legs = [rest(10.0, 0.0), rest(5.0)]
    for factor in rng.uniform(0.5, 5, rng.integers(2, 6)):
        back = Leg(-lab.speed * 5 * factor, duration / 5, 0.0)
        legs += [Leg(lab.speed * factor, duration), rest(5.0, 0.0), back, rest(5.0, 0.0), rest(5.0)]
    made = record(
        rng, lab, legs, draw_law(rng, lab), rate=2000 / duration, offset=rng.uniform(-1, 1)
    )
    names = [("friction_force", "normal_force", "position"), ()][rng.integers(2)]
    return Trial(made.dataset(*names), made.truth)


@tricky("5")
def wide_speeds(rng) -> Trial:
    """Speeds over four decades in one record, from an encoder alone."""
    lab = draw_lab(rng, speed=(5e-7, 5e-6))
    legs = [rest(10.0, 0.0), rest(5.0)]
    for speed in lab.speed * np.geomspace(1, 1e4, 5):
        duration = float(np.clip(2e-3 / speed, 4.0, 300.0))
        legs += [*strokes([speed], duration, 1.0)]
    made = record(rng, lab, legs, draw_law(rng, lab, slope=0.1), rate=50.0, ramp=0.1)
    return Trial(made.dataset("friction_force", "normal_force", "position"), made.truth)


@tricky("7")
def few_samples(rng) -> Trial:
    """A slow logger: a dozen to forty samples in each stroke, and noise with a memory."""
    lab = replace(
        draw_lab(rng), kind=str(rng.choice(["white", "red"])), noise=rng.uniform(0.01, 0.1)
    )
    duration = rng.uniform(10, 60)
    count = int(rng.integers(16, 50))
    legs = [rest(duration, 0.0), rest(duration / 3)]
    legs += strokes(lab.speed * np.array([1.0, 2.2, 5.0]), duration, duration / 3)
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=count / duration,
        ramp=0.02 * duration,
        offset=rng.uniform(-0.5, 0.5),
    )
    return Trial(made.dataset(), made.truth)


@tricky("7")
def running_in(rng) -> Trial:
    """Friction falls or rises several times over while it slides."""
    lab = draw_lab(rng)
    duration = rng.uniform(20, 200)
    surplus = float(rng.choice([-0.8, 1.5, 6.0]))
    law = draw_law(
        rng, lab, run_in=surplus, run_in_distance=lab.speed * duration * rng.uniform(0.5, 3)
    )
    legs = [
        rest(10.0, 0.0),
        rest(5.0),
        *strokes([lab.speed], duration, 2.0) * int(rng.integers(1, 4)),
    ]
    legs += [rest(10.0, 0.0)]
    made = record(rng, lab, legs, law, rate=1500 / duration)
    return Trial(made.dataset(), made.truth)


@tricky("4")
def slow_acceleration(rng) -> Trial:
    """Plateaus joined by ramps as long as themselves."""
    lab = draw_lab(rng, speed=(1e-5, 1.0))
    duration = rng.uniform(5, 30)
    legs = [rest(10.0, 0.0), rest(5.0)]
    legs += [Leg(lab.speed * f, duration) for f in (1.0, 2.0, 4.0, 1.5)] + [
        rest(5.0),
        rest(10.0, 0.0),
    ]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(20, 200), ramp=duration)
    return Trial(made.dataset(), made.truth)
