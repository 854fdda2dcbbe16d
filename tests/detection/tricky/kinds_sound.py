"""Sound runs of the same labs: two ways or unloaded rests, steady noise, enough samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.files import Column, dialect, table
from tricky.kinds_clocks import two_files
from tricky.lab import draw_lab, draw_law, record
from tricky.motion import rest, strokes
from tricky.trial import Trial, sound


def _calm(rng, **ranges):
    lab = draw_lab(rng, noises=("white",), **ranges)
    return replace(lab, noise=min(lab.noise, 0.02))


@sound
def pin_on_disc(rng) -> Trial:
    """One way, unloaded before and after."""
    lab = _calm(rng, load=(1.0, 60.0), speed=(0.01, 0.5), mu=(0.05, 0.9))
    legs = [rest(15.0, 0.0), rest(4.0), *strokes([lab.speed], rng.uniform(60, 200), 2.0, (1,))]
    legs += [rest(4.0), rest(15.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=20.0, offset=rng.uniform(-0.1, 0.1))
    return Trial(made.dataset(), made.truth)


@sound
def reciprocating(rng) -> Trial:
    """Many equal strokes both ways."""
    lab = _calm(rng, load=(0.5, 100.0), speed=(1e-3, 0.05), mu=(0.05, 1.2))
    duration = rng.uniform(3, 20)
    legs = [rest(5.0), *strokes([lab.speed] * int(rng.integers(5, 12)), duration, 0.5), rest(5.0)]
    made = record(
        rng, lab, legs, draw_law(rng, lab), rate=rng.uniform(40, 120), offset=rng.uniform(-0.2, 0.2)
    )
    return Trial(made.dataset(), made.truth)


@sound
def linear_steps(rng) -> Trial:
    """A sled at rising speeds, both ways."""
    lab = _calm(rng, load=(1.0, 200.0), speed=(1e-5, 1e-3), mu=(0.05, 1.5))
    legs = [rest(10.0, 0.0), rest(4.0)]
    legs += [*strokes(lab.speed * np.geomspace(1, 30, 5), rng.uniform(10, 30), 1.0)]
    legs += [rest(4.0), rest(10.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=50.0, offset=rng.uniform(-0.2, 0.2))
    return Trial(made.dataset(), made.truth)


@sound
def micro_tribometer(rng) -> Trial:
    """Millinewtons at micrometres per second, both ways, from the position."""
    lab = _calm(rng, load=(0.05, 0.5), speed=(5e-7, 1e-4), mu=(0.1, 2.0))
    legs = [rest(5.0), *strokes([lab.speed] * 4, rng.uniform(20, 80), 2.0), rest(5.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=25.0, offset=rng.uniform(-0.2, 0.2))
    return Trial(made.dataset("friction_force", "normal_force", "position"), made.truth)


@sound
def heavy_rig(rng) -> Trial:
    """Hundreds of newtons to kilonewtons, one way, unloaded between the speeds."""
    lab = _calm(rng, load=(300.0, 2000.0), speed=(1e-3, 0.3), mu=(0.01, 0.3))
    legs = [rest(12.0, 0.0), rest(4.0)]
    for factor in (1.0, 2.0, 4.0):
        legs += [*strokes([lab.speed * factor], rng.uniform(20, 60), 2.0, (1,))]
        legs += [rest(12.0, 0.0), rest(4.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=40.0, offset=rng.uniform(-0.2, 0.2))
    return Trial(made.dataset(), made.truth)


@sound
def ring_steps(rng) -> Trial:
    """A ring turns both ways at speeds that rise and fall, from velocity and position."""
    lab = _calm(rng, load=(5.0, 300.0), speed=(1e-3, 0.05), mu=(0.02, 0.6))
    speeds = lab.speed * np.array([1, 3, 9, 3, 1])
    legs = [rest(6.0), *strokes(speeds, rng.uniform(8, 30), 1.0), rest(5.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=100.0, offset=rng.uniform(-0.2, 0.2))
    names = ("friction_force", "normal_force", "sliding_velocity", "position")
    return Trial(made.dataset(*names), made.truth)


@sound
def drafted_sled(rng) -> Trial:
    """A sled's file as its lab writes it, with a drafted dialect."""
    lab = _calm(rng, load=(1.0, 200.0), speed=(1e-3, 5e-2), mu=(0.05, 1.2))
    legs = [rest(6.0), *strokes(lab.speed * np.array([1, 2, 4]), rng.uniform(10, 30), 1.0)]
    made = record(
        rng, lab, legs + [rest(5.0)], draw_law(rng, lab), rate=50.0, offset=rng.uniform(-0.2, 0.2)
    )
    columns = [
        Column("time", "Time", "s", made.motion.time, ".3f"),
        Column("friction_force", "Friction force", "N", made.friction),
        Column("normal_force", "Normal force", "N", made.normal),
        Column("sliding_velocity", "Velocity", "mm/s", 1e3 * made.velocity),
    ]
    return Trial({"sled_07.csv": table(columns)}, made.truth)


@sound
def disc_in_rpm(rng) -> Trial:
    """Pin on disc with a speed in rpm and its radius."""
    lab = _calm(rng, load=(1.0, 60.0), speed=(0.01, 0.5), mu=(0.05, 0.9))
    legs = [rest(15.0, 0.0), rest(4.0), *strokes([lab.speed], rng.uniform(60, 200), 2.0, (1,))]
    legs += [rest(4.0), rest(15.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=20.0, offset=rng.uniform(-0.1, 0.1))
    columns = [
        Column("time", "t", "s", made.motion.time, ".3f"),
        Column("friction_force", "Ff", "N", made.friction),
        Column("normal_force", "Fn", "N", made.normal),
        Column("rotation_speed", "n", "rpm", made.velocity / 0.02 * 30 / np.pi),
    ]
    speed = 'source = "rotation"\nradius = "20 mm"'
    return Trial(
        {"disc_07.csv": table(columns)}, made.truth, {"disc": dialect("disc", columns, speed=speed)}
    )


@sound
def two_logs(rng) -> Trial:
    """A force log and a motion log whose clocks differ; rests before, between and after."""
    lab = _calm(rng, load=(5.0, 200.0), speed=(2e-3, 3e-2), mu=(0.1, 1.0))
    speeds = lab.speed * np.array([1.0, 2.0, 5.0])
    legs = [rest(6.0, 0.0), rest(5.0), *strokes(speeds, 12.0, 2.0), rest(6.0)]
    law = draw_law(rng, lab, build_up=0.005 * lab.speed)
    made = record(rng, lab, legs, law, rate=100.0, offset=rng.uniform(-0.2, 0.2))
    return two_files(rng, made, motion_rate=100.0)
