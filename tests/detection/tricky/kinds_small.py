"""Small faults that once passed: one of each kind, drawn with other numbers every time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.files import Column, table
from tricky.lab import draw_lab, draw_law, record
from tricky.motion import Leg, rest, run_programme, strokes
from tricky.trial import Trial, tricky

FORCES = ("friction_force", "normal_force")


@tricky("11")
def drift_after_one_rest(rng) -> Trial:
    """One unloaded rest, then strokes both ways while the zero drifts by up to the friction."""
    lab = draw_lab(rng, mu=(0.1, 1.0))
    duration, total = rng.uniform(5, 30), float(rng.choice([-1, 1]) * rng.uniform(0.2, 0.9))
    legs = [*strokes([lab.speed] * int(rng.integers(4, 9)), duration, rng.choice([0.0, 1.0]))]
    bare = rest(8.0, 0.0)
    legs = [bare, rest(3.0), *legs] if rng.integers(2) else [rest(3.0), *legs, rest(2.0), bare]
    rate = rng.uniform(400, 1500) / duration
    law = draw_law(rng, lab)
    return _trial(record(rng, lab, legs, law, rate=rate, drift=lambda u: total * u))


def _trial(made, *names) -> Trial:
    return Trial(made.dataset(*names), made.truth)


@tricky("8")
def unsigned_sharp(rng) -> Trial:
    """Friction without its sign that turns over within one sample, with an offset."""
    lab = draw_lab(rng, mu=(0.1, 1.0))
    duration, rate = rng.uniform(2, 20), rng.uniform(5, 50)
    legs = [rest(3.0), *strokes([lab.speed] * int(rng.integers(3, 10)), duration), rest(2.0)]
    law = draw_law(rng, lab, build_up=lab.speed / rate * rng.uniform(0.01, 2))
    ramp = rng.uniform(0.05, 1) / rate
    offset = float(rng.choice([-1, 1]) * rng.uniform(0.02, 0.9))
    made = record(rng, lab, legs, law, rate=rate, ramp=ramp, offset=offset)
    run = made.dataset()
    return Trial(run.assign(friction_force=abs(run.friction_force)), made.truth)


@tricky("8")
def unsigned_coefficient(rng) -> Trial:
    """A coefficient without its sign that turns over within one sample, with an offset."""
    trial = unsigned_sharp(rng)
    ratio = trial.data.friction_force / trial.data.normal_force
    run = trial.data.assign(friction_coefficient=ratio.assign_attrs(units="1"))
    return Trial(run.drop_vars(["friction_force", "normal_force"]), trial.truth)


@tricky("5")
def stage_stops(rng) -> Trial:
    """A set speed beside the position of a stage that stops for half of some strokes."""
    lab = draw_lab(rng, speed=(1e-5, 1e-2), mu=(0.1, 1.0))
    duration = rng.uniform(8, 30)
    legs, wanted = [rest(6.0, 0.0), rest(3.0)], [(rest(6.0, 0.0)), rest(3.0)]
    for k in range(int(rng.integers(2, 5))):
        for way in (1, -1):
            share = 0.5 if k % 2 == 0 else 1.0
            legs += [Leg(way * lab.speed, share * duration)]
            legs += [rest((1 - share) * duration - 0.05)] if share < 1 else []
            wanted += [Leg(way * lab.speed, duration)]
    legs, wanted = ([*own, rest(6.0, 0.0)] for own in (legs, wanted))
    rate = rng.uniform(500, 1500) / duration
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rate)
    asked = run_programme(wanted, rate).velocity
    size = min(asked.size, made.motion.time.size)
    run = made.dataset(*FORCES, "position").isel(time=slice(size))
    speed = ("time", np.round(asked[:size] / lab.speed) * lab.speed, {"units": "m/s"})
    return Trial(run.assign(sliding_velocity=speed), made.truth)


@tricky("4")
def short_dwells(rng) -> Trial:
    """Many short strokes from the position, with short dwells between them."""
    lab = draw_lab(rng, speed=(1e-3, 2e-2), mu=(0.05, 1.0))
    duration = rng.uniform(0.4, 2.0)
    legs = [rest(2.0), *strokes([lab.speed] * int(rng.integers(8, 20)), duration, duration / 8)]
    rate, ramp = rng.uniform(60, 200) / duration, 0.01 * duration
    made = record(
        rng, lab, [*legs, rest(2.0)], draw_law(rng, lab), rate=rate, ramp=ramp, offset=0.1
    )
    return _trial(made, *FORCES, "position")


@tricky("5")
def rate_falls(rng) -> Trial:
    """A logger that keeps only every 50th or 200th row for a while, as friction changes."""
    lab = draw_lab(rng, mu=(0.1, 1.0))
    duration, step = rng.uniform(100, 300), int(rng.choice([50, 200]))
    legs = [rest(15.0, 0.0), rest(5.0), Leg(lab.speed, duration), rest(5.0), rest(15.0, 0.0)]
    a, b = np.sort(rng.uniform(30, duration, 2))
    size = rng.uniform(-0.4, 0.6)
    made = record(rng, lab, legs, draw_law(rng, lab), rate=100.0)
    slow = (made.motion.time > a) & (made.motion.time < b)
    bump = 1 + size * slow
    run = made.dataset()
    run = run.assign(friction_force=run.friction_force * bump)
    truth = replace(made.truth, mu=made.truth.mu * bump)
    keep = ~slow | (np.arange(slow.size) % step == 0)
    return Trial(run.isel(time=keep), truth)


@tricky("13")
def fine_speeds(rng) -> Trial:
    """Some 98 speeds in fine steps over four decades, both ways, from the position."""
    lab = draw_lab(rng, speed=(1e-6, 1e-5), mu=(0.05, 1.0))
    speeds = lab.speed * np.geomspace(1, 1e4, int(rng.integers(90, 106)))
    legs = [rest(5.0, 0.0), rest(3.0), *strokes(speeds, rng.uniform(4, 8)), rest(5.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=25.0, offset=0.1)
    return _trial(made, *FORCES, "position")


@tricky("7")
def rotation_in_header(rng) -> Trial:
    """A pin on disc whose rotation and radius stand above the table only."""
    lab = draw_lab(rng, load=(1.0, 60.0), speed=(0.01, 0.5), mu=(0.1, 0.9))
    legs = [rest(10.0, 0.0), Leg(lab.speed, rng.uniform(60, 200)), rest(10.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=20.0)
    radius = rng.uniform(5, 30)
    turns = 60 * lab.speed / (2 * np.pi * radius * 1e-3)
    columns = [
        Column("time", "Time", "s", made.motion.time, ".3f"),
        Column("friction_force", "Friction force", "N", made.friction),
        Column("normal_force", "Normal force", "N", made.normal),
    ]
    head = f"Rotation speed: {turns:.4f} rpm\nTrack radius: {radius:.3f} mm\n"
    return Trial({"disc.csv": head + table(columns)}, made.truth)


@tricky("12")
def error_of_its_value(rng) -> Trial:
    """One short stroke in which friction wanders by as much as it is."""
    lab = draw_lab(rng, mu=(0.05, 0.5))
    duration, size = rng.uniform(20, 60), rng.uniform(0.4, 1.2)
    legs = [rest(8.0, 0.0), rest(3.0), Leg(lab.speed, duration), rest(3.0), rest(8.0, 0.0)]
    walk = np.cumsum(rng.standard_normal(20000))
    walk = size * (walk - walk.mean()) / np.ptp(walk)

    def fluctuation(time: np.ndarray) -> np.ndarray:
        return np.interp(time / time[-1], np.linspace(0, 1, walk.size), walk)

    made = record(rng, lab, legs, draw_law(rng, lab), rate=1000 / duration, fluctuation=fluctuation)
    return _trial(made)
