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
    truth = Truth(empty, empty, empty, made.truth.time, made.truth.mu, made.motion.velocity)
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
        rng, lab, legs, draw_law(rng, lab), rate=2000 / duration, offset=rng.uniform(-0.4, 0.4)
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


@tricky("4")
def bulging(rng) -> Trial:
    """Speed sags (or swells) by 25 to 60 % in the middle of each stroke and comes back."""
    lab = draw_lab(rng)
    change = float(rng.choice([-1, 1]) * rng.uniform(0.25, 0.6))
    duration = rng.uniform(10, 80)
    legs = [rest(6.0, 0.0), rest(3.0)]
    for way in (1, -1) * 3:
        bulge = shaped(way * lab.speed, duration, lambda u: 1 - change * 4 * u * (1 - u))
        legs += [bulge, rest(2.0)]
    return _nothing(record(rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(10, 100)))


@tricky("4")
def crank_by_position(rng) -> Trial:
    """A crank again, but only the position is recorded."""
    lab = draw_lab(rng, speed=(1e-3, 1.0))
    cycles = int(rng.integers(3, 20))
    period = rng.uniform(0.5, 10)
    legs = [rest(5.0, 0.0), rest(3.0)]
    legs += [shaped(lab.speed, period * cycles, lambda u: np.sin(2 * np.pi * cycles * u))]
    made = record(
        rng, lab, legs + [rest(3.0)], draw_law(rng, lab), rate=60 / period * rng.uniform(1, 5)
    )
    trial = _nothing(made)
    return replace(trial, data=made.dataset("friction_force", "normal_force", "position"))


@tricky("5")
def paused_logger(rng) -> Trial:
    """The logger pauses: a tenth to a third of some strokes is missing, time goes on."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 80)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed, 2 * lab.speed], duration, 1.0)]
    made = record(
        rng,
        lab,
        legs + [rest(8.0, 0.0)],
        draw_law(rng, lab),
        rate=rng.uniform(800, 3000) / duration,
        offset=rng.uniform(-0.4, 0.4),
    )
    keep = np.ones(made.motion.time.size, dtype=bool)
    for i in rng.permutation(made.truth.start.size)[: rng.integers(1, 3)]:
        first = made.truth.start[i] + rng.uniform(0.1, 0.5) * duration
        gone = first + rng.uniform(0.1, 0.33) * duration
        keep &= (made.motion.time < first) | (made.motion.time > gone)
    return Trial(made.dataset().isel(time=keep), made.truth)


@tricky("5")
def jittery_clock(rng) -> Trial:
    """Samples come when they come: the spacing scatters, and some rows are lost."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 80)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed, 2 * lab.speed], duration, 1.0)]
    made = record(
        rng,
        lab,
        legs + [rest(8.0, 0.0)],
        draw_law(rng, lab),
        rate=rng.uniform(3000, 8000) / duration,
        offset=rng.uniform(-0.4, 0.4),
    )
    keep = rng.random(made.motion.time.size) < rng.uniform(0.85, 0.98)
    return Trial(made.dataset().isel(time=keep), made.truth)


@tricky("4")
def close_speeds(rng) -> Trial:
    """Plateaus whose speeds differ by 6 to 15 % follow each other without a rest."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 60)
    factor = 1 + rng.uniform(0.06, 0.15)
    legs = [rest(8.0, 0.0), rest(3.0)]
    legs += [Leg(lab.speed * factor**k, duration) for k in (0, 1, 0, 2, 1)] + [rest(3.0)]
    law = draw_law(rng, lab, stribeck=0.0, slope=rng.uniform(0.5, 1.5))
    made = record(
        rng,
        lab,
        legs + [rest(8.0, 0.0)],
        law,
        rate=rng.uniform(800, 3000) / duration,
        offset=rng.uniform(-0.4, 0.4),
    )
    return Trial(made.dataset(), made.truth)


@tricky("7")
def spiky(rng) -> Trial:
    """A switch nearby: single samples stand out by ten to thirty times the noise."""
    lab = replace(draw_lab(rng), kind="spikes")
    duration = rng.uniform(10, 60)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed, 2 * lab.speed], duration, 1.0)]
    law = draw_law(rng, lab)
    made = record(rng, lab, legs, law, rate=rng.uniform(800, 3000) / duration, offset=0.1)
    return Trial(made.dataset(), made.truth)


@tricky("7")
def faint_friction_of_an_air_bearing(rng) -> Trial:
    """The noise is one to five times the friction."""
    lab = replace(draw_lab(rng, mu=(0.003, 0.05)), kind="white", noise=rng.uniform(1, 5))
    duration = rng.uniform(10, 60)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed, 2 * lab.speed], duration, 1.0)]
    law = draw_law(rng, lab)
    made = record(rng, lab, legs, law, rate=rng.uniform(800, 3000) / duration, offset=0.4)
    return Trial(made.dataset(), made.truth)


@tricky("7")
def track_gradient(rng) -> Trial:
    """Friction rises along the track: up in one way, down in the other, the same mean."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 60)
    rise = rng.uniform(0.02, 0.3)
    legs = [rest(8.0, 0.0), rest(3.0), *strokes([lab.speed] * 3, duration, 1.0)]
    made = record(
        rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(800, 3000) / duration, offset=0.2
    )
    along = made.motion.position / np.ptp(made.motion.position)
    factor = 1 + rise * (along - 0.5)
    noise = made.friction - made.slid.ratio * lab.load
    friction = made.slid.ratio * factor * lab.load + noise
    truth = replace(made.truth, mu=made.truth.mu * factor)
    return Trial(replace(made, friction=friction).dataset(), truth)
