"""Two logs, two clocks: inertia, slack, coarse motion logs, and companions of another day."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.files import Column, dialect, table
from tricky.lab import draw_lab, draw_law, record
from tricky.motion import Leg, rest, strokes
from tricky.trial import Trial, tricky

PAIR = '[pair]\nown = "_force"\nother = "_motion"\ninstrument = "{folder}/other_lab_motion.toml"\n'
DATE = "[[value]]\nname = \"recorded_at\"\npattern = '^# date: (\\S+)'\n"


def _lab(rng):
    lab = draw_lab(rng, load=(1.0, 500), speed=(1e-3, 0.3), mu=(0.05, 1.2))
    return replace(lab, kind=str(rng.choice(["white", "red"])), noise=rng.uniform(0.005, 0.03))


def _legs(rng, lab, pause=1.0, pairs=3, duration=None):
    duration = rng.uniform(4, 15) if duration is None else duration
    return [rest(4.0), *strokes(lab.speed * rng.uniform(0.4, 3, pairs), duration, pause), rest(4.0)]


def two_files(
    rng, made, *, shift=None, motion=None, dates=None, motion_rate=None, delay=0.0
) -> Trial:
    """Write a force log and a motion log of its own rate; motion's clock + shift = force's."""
    shift = rng.uniform(-8, 8) if shift is None else shift
    motion = made if motion is None else motion
    time = motion.motion.time
    rate = motion_rate or rng.choice([20.0, 50.0, 100.0])
    clock = np.arange(time[0] + 0.3, time[-1] - 0.4, 1.0 / rate)
    force_columns = [
        Column("time", "Time", "s", made.motion.time, ".5f"),
        Column("friction_force", "Fx", "N", made.friction),
        Column("normal_force", "Fz", "N", made.normal),
    ]
    position = np.interp(clock - delay, time, motion.motion.position)
    velocity = np.interp(clock - delay, time, motion.motion.velocity)
    top = np.abs(velocity).max()
    velocity = velocity + 0.004 * top * rng.standard_normal(clock.size)
    motion_columns = [
        Column("time", "Time", "s", clock - shift, ".5f"),
        Column("position", "Position", "mm", 1e3 * position),
        Column("sliding_velocity", "Velocity", "mm/s", 1e3 * velocity),
    ]
    preambles = [[f"# date: {d}"] if d else [] for d in (dates or ("", ""))]
    files = {
        "run_01_force.csv": table(force_columns, preamble=preambles[0]),
        "run_01_motion.csv": table(motion_columns, preamble=preambles[1]),
    }
    value = DATE if dates else ""
    dialects = {
        "other_lab": dialect("other_lab", force_columns, preamble=preambles[0], more=PAIR + value),
        "other_lab_motion": dialect(
            "other_lab_motion", motion_columns, preamble=preambles[1], more=value
        ),
    }
    return Trial(files, made.truth, dialects, clock_shift=shift)


@tricky("3")
def inertia(rng) -> Trial:
    """A heavy slider hangs on the sensor: its acceleration is one to ten times the friction."""
    lab = _lab(rng)
    ramp = rng.uniform(0.1, 0.8)
    legs = _legs(rng, lab, pause=float(rng.choice([0.0, 1.0])))
    mass = rng.uniform(1, 10) * lab.friction / (2 * lab.speed / ramp)
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.choice([100.0, 250.0]),
        ramp=ramp,
        mass=mass,
        offset=rng.uniform(-0.4, 0.4),
    )
    return two_files(rng, made)


@tricky("3")
def slack(rng) -> Trial:
    """Play between stage and slider: after a reversal friction turns over some way later."""
    lab = _lab(rng)
    made = record(
        rng,
        lab,
        _legs(rng, lab, pairs=4),
        draw_law(rng, lab, build_up=0.0),
        rate=100.0,
        offset=rng.uniform(-0.4, 0.4),
    )
    play = np.abs(made.truth.speed).min() * rng.uniform(0.1, 0.8)
    taken_up = made.slid.slid_since_reversal >= play
    held = np.where(taken_up, made.slid.ratio * lab.load, 0.0)  # no force while the play is open
    noise = made.friction - made.slid.ratio * lab.load
    return two_files(rng, replace(made, friction=held + noise))


@tricky("3")
def soft_build_up(rng) -> Trial:
    """A soft mount: friction turns over within a tenth to a third of the stroke."""
    lab = _lab(rng)
    duration = rng.uniform(5, 15)
    law = draw_law(rng, lab, build_up=lab.speed * duration * rng.uniform(0.02, 0.08))
    legs = [rest(4.0), *strokes([lab.speed] * 4, duration, 1.0), rest(4.0)]
    made = record(rng, lab, legs, law, rate=100.0, offset=rng.uniform(-0.4, 0.4))
    return two_files(rng, made)


@tricky("3")
def equal_strokes(rng) -> Trial:
    """Many strokes alike, the shift longer than one: the logs match at each multiple."""
    lab = _lab(rng)
    duration = rng.uniform(1.5, 4)
    legs = [*strokes([lab.speed] * 20, duration, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=100.0, offset=rng.uniform(-0.4, 0.4))
    return two_files(rng, made, shift=rng.uniform(-3, 3) * duration)


@tricky("3")
def one_long_slide(rng) -> Trial:
    """A single slide one way that begins before the log and ends after it: no mark at all."""
    lab = _lab(rng)
    legs = [Leg(lab.speed, 30.0), Leg(1.5 * lab.speed, 30.0), Leg(0.7 * lab.speed, 30.0)]
    law = replace(draw_law(rng, lab), slope=0.0, stribeck=0.0)
    made = record(rng, lab, [rest(6.0, 0.0), rest(2.0), *legs], law, rate=50.0)
    late = int(12.0 * made.motion.rate)
    return two_files(rng, _cut(made, late))


def _cut(made, first):
    motion = made.motion
    parts = ("time", "velocity", "acceleration", "position", "load")
    cut = {name: getattr(motion, name)[first:] for name in parts}
    signals = ("normal", "friction", "velocity", "position")
    return replace(
        made, motion=replace(motion, **cut), **{n: getattr(made, n)[first:] for n in signals}
    )


@tricky("3")
def coarse_motion_log(rng) -> Trial:
    """The motion log has two to ten rows in a second."""
    lab = _lab(rng)
    legs = _legs(rng, lab, duration=rng.uniform(8, 30))
    made = record(
        rng, lab, legs, draw_law(rng, lab), rate=100.0, ramp=0.2, offset=rng.uniform(-0.4, 0.4)
    )
    return two_files(rng, made, motion_rate=rng.uniform(2, 10))


@tricky("3")
def companion_of_another_day(rng) -> Trial:
    """The log beside it carries the same name, but was recorded on another day."""
    lab = _lab(rng)
    duration = rng.uniform(4, 15)
    made = record(rng, lab, _legs(rng, lab, duration=duration), draw_law(rng, lab), rate=100.0)
    other = replace(lab, speed=lab.speed * rng.uniform(0.5, 2))
    legs = _legs(rng, other, duration=duration * rng.choice([1.0, rng.uniform(0.7, 1.4)]))
    motion = record(rng, other, legs, draw_law(rng, other), rate=100.0)
    dates = ("2026-03-02T10:00:00", f"2026-03-{rng.integers(3, 28):02d}T10:00:07")
    made = two_files(rng, made, motion=motion, dates=dates)
    return replace(made, unsure_only=True, clock_shift=None)


@tricky("3")
def companion_of_another_run(rng) -> Trial:
    """The log beside it is of another run with other strokes; no file says when."""
    lab = _lab(rng)
    made = record(rng, lab, _legs(rng, lab), draw_law(rng, lab), rate=100.0)
    legs = _legs(rng, lab, pairs=int(rng.integers(2, 5)))
    motion = record(rng, lab, legs, draw_law(rng, lab), rate=100.0)
    return replace(two_files(rng, made, motion=motion), unsure_only=True, clock_shift=None)


@tricky("3")
def faint_friction(rng) -> Trial:
    """Friction is hardly above its noise and its drift."""
    lab = replace(_lab(rng), noise=rng.uniform(0.3, 1.5))
    total = rng.uniform(-2, 2)
    made = record(
        rng, lab, _legs(rng, lab), draw_law(rng, lab), rate=50.0, drift=lambda u: total * u
    )
    return two_files(rng, made)


@tricky("3")
def short_strokes(rng) -> Trial:
    """Strokes of one to two seconds: a tenth of a second counts."""
    lab = _lab(rng)
    legs = _legs(rng, lab, pause=0.5, pairs=5, duration=rng.uniform(1.0, 2.0))
    made = record(
        rng,
        lab,
        legs,
        draw_law(rng, lab, build_up=0.02 * lab.speed),
        rate=200.0,
        offset=rng.uniform(-0.4, 0.4),
    )
    return two_files(rng, made)
