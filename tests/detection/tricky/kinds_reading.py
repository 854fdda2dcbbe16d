"""Tricky files: reciprocal times, clocks that restart or wrap, coarse stamps, foreign units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tricky.files import Column, dialect, table
from tricky.lab import draw_lab, draw_law, record
from tricky.motion import rest, strokes
from tricky.trial import Trial, tricky

PER_RADIAN = {  # of a rotation speed in this unit
    "1/min": 30 / np.pi,
    "min-1": 30 / np.pi,
    "min^-1": 30 / np.pi,
    "rev/min": 30 / np.pi,
    "U/min": 30 / np.pi,
    "rpm": 30 / np.pi,
    "1/s": 0.5 / np.pi,
    "s-1": 0.5 / np.pi,
    "Hz": 0.5 / np.pi,
    "rev/s": 0.5 / np.pi,
    "deg/s": 180 / np.pi,
    "rad/s": 1.0,
}


BLOCKS = "pattern = '^Time'\nrepeats = true\nstep = '^Step (\\d+)'"


def _disc(rng):
    """Pin on disc: one way at some speeds, unloaded before and after; noise without surprises."""
    lab = replace(draw_lab(rng, load=(0.5, 100), speed=(0.01, 1.0), mu=(0.02, 1.2)), kind="white")
    legs = [rest(12.0, 0.0), rest(4.0)]
    legs += strokes(lab.speed * np.array([1.0, 0.5, 2.0]), rng.uniform(20, 60), 3.0, (1,))
    legs += [rest(3.0), rest(12.0, 0.0)]
    law = draw_law(rng, lab)
    return record(rng, lab, legs, law, rate=20.0, offset=rng.uniform(-0.3, 0.3))


def _sled(rng, pause=1.0, pairs=3, **more):
    """Strokes both ways."""
    lab = replace(draw_lab(rng, load=(0.5, 500), speed=(1e-4, 0.1), mu=(0.02, 1.5)), kind="white")
    duration = rng.uniform(10, 40)
    legs = [rest(4.0), *strokes(lab.speed * rng.uniform(0.5, 3, pairs), duration, pause)]
    rate = float(rng.choice([10, 20, 50]))
    return record(
        rng, lab, legs, draw_law(rng, lab), rate=rate, offset=rng.uniform(-0.3, 0.3), **more
    )


def _columns(made, time=None, form=".4f", first="Time"):
    time = made.motion.time if time is None else time
    return [
        Column("time", first, "s", time, form),
        Column("friction_force", "Friction force", "N", made.friction),
        Column("normal_force", "Normal force", "N", made.normal),
        Column("sliding_velocity", "Velocity", "mm/s", 1e3 * made.velocity),
    ]


def _one_file(columns, truth, toml=None, name="run_01.csv", text=None, **more) -> Trial:
    files = {name: table(columns) if text is None else text}
    return Trial(files, truth, {} if toml is None else {"other_lab": toml}, **more)


@tricky("1")
def reciprocal_time(rng) -> Trial:
    """A rotation speed in 1/min, min-1, U/min, Hz and their like, and a radius."""
    made = _disc(rng)
    unit = str(rng.choice(list(PER_RADIAN)))
    radius = rng.uniform(0.005, 0.05)
    turning = made.velocity / radius * PER_RADIAN[unit]
    columns = [
        *_columns(made)[:3],
        Column("rotation_speed", "Rotation speed", unit, turning),
    ]
    toml = dialect(
        "other_lab", columns, speed=f'source = "rotation"\nradius = "{1e3 * radius:.9g} mm"'
    )
    return _one_file(columns, made.truth, toml, note=unit)


@tricky("1")
def reciprocal_time_in_units_row(rng) -> Trial:
    """The same from a file with a row of units, a decimal comma and a radius in the preamble."""
    made = _disc(rng)
    unit = str(rng.choice(["1/min", "U/min", "min-1", "1/s", "Hz"]))
    radius = round(rng.uniform(5, 50), 3)
    columns = [
        Column("time", "Zeit", "s", made.motion.time),
        Column("friction_force", "Reibkraft", "N", made.friction),
        Column("normal_force", "Normalkraft", "N", made.normal),
        Column("rotation_speed", "Drehzahl", unit, made.velocity / radius * 1e3 * PER_RADIAN[unit]),
    ]
    preamble = [f"Radius: {radius} mm"]
    how = {"delimiter": ";", "decimal": ",", "units": "row", "preamble": preamble}
    value = (
        '[[value]]\nname = "track_radius"\npattern = \'Radius: (\\S+) mm\'\nunit = "mm"\nto = "m"\n'
    )
    toml = dialect(
        "other_lab",
        columns,
        **how,
        speed='source = "rotation"\nradius_value = "track_radius"',
        more=value,
    )
    return _one_file(columns, made.truth, toml, text=table(columns, **how), note=unit)


def _steps(made, pause=1.0):
    """Time within each step (a stroke with its pause), and the step's number."""
    begins = np.concatenate([[0.0], made.truth.stop[:-1] + 0.5 * pause])
    step = np.searchsorted(begins, made.motion.time, "right") - 1
    first = np.searchsorted(step, np.arange(begins.size))
    return made.motion.time - made.motion.time[first][step], step + 1


@tricky("2")
def clock_restarts_with_step(rng) -> Trial:
    """One table; the clock starts anew at each step, and a column counts the steps; drafted."""
    made = _sled(rng)
    time, step = _steps(made)
    columns = [Column("step", "Step", "", step, "d"), *_columns(made, time)]
    return _one_file(columns, made.truth, lost_is_wrong=True)


@tricky("2")
def clock_restarts(rng) -> Trial:
    """The same without a column that counts; drafted."""
    made = _sled(rng)
    return _one_file(_columns(made, _steps(made)[0]), made.truth, lost_is_wrong=True)


@tricky("2")
def clock_restarts_stated(rng) -> Trial:
    """The same with a dialect that says restart = "continue", with and without a step column."""
    made = _sled(rng)
    time, step = _steps(made)
    columns = _columns(made, time)
    if rng.integers(2):
        columns = [Column("step", "Step", "1", step, "d"), *columns]
    toml = dialect("other_lab", columns, time='restart = "continue"')
    return _one_file(columns, made.truth, toml, lost_is_wrong=True)


@tricky("2")
def clock_restarts_dropped(rng) -> Trial:
    """The same with a dialect that says on_repeat = "drop": most rows would go."""
    made = _sled(rng)
    columns = _columns(made, _steps(made)[0])
    toml = dialect("other_lab", columns, time='on_repeat = "drop"')
    return _one_file(columns, made.truth, toml, lost_is_wrong=True)


@tricky("2")
def clock_wraps(rng) -> Trial:
    """A counter of the logger runs over at 65.536, 32.768 or 100 s; drafted or stated."""
    made = _sled(rng, pairs=4)
    wrap = float(rng.choice([65.536, 32.768, 100.0]))
    columns = _columns(made, made.motion.time % wrap)
    stated = dialect("other_lab", columns, time='restart = "continue"')
    return _one_file(
        columns, made.truth, [None, stated][rng.integers(2)], lost_is_wrong=True, note=f"{wrap}"
    )


@tricky("2")
def coarse_stamps(rng) -> Trial:
    """The clock is written with too few digits, so that two to five rows share one stamp."""
    made = _sled(rng)
    digit = float(rng.integers(2, 6)) / made.motion.rate
    time = np.floor(made.motion.time / digit + 1e-6) * digit
    return _one_file(_columns(made, time), made.truth, lost_is_wrong=True)


@tricky("2")
def doubled_rows(rng) -> Trial:
    """The logger writes some rows twice; drafted."""
    made = _sled(rng)
    again = np.sort(
        np.concatenate(
            [
                np.arange(made.motion.time.size),
                rng.integers(0, made.motion.time.size, made.motion.time.size // 200),
            ]
        )
    )
    columns = [replace(c, values=c.values[again]) for c in _columns(made)]
    return _one_file(columns, made.truth, lost_is_wrong=True)


@tricky("2")
def header_repeats(rng) -> Trial:
    """A block for each step, each with its header and its own clock; steps follow at once."""
    made = _sled(rng)
    time, step = _steps(made)
    columns = _columns(made, time)
    text = ""
    for number in range(1, step[-1] + 1):
        part = [replace(c, values=c.values[step == number]) for c in columns]
        text += f"Step {number}\n" + table(part)
    toml = dialect("other_lab", columns, preamble=[""], time='restart = "continue"')
    toml = toml.replace("line = 2", BLOCKS).replace("[header]", "end = '^Step'\n[header]")
    return _one_file(columns, made.truth, toml, text=text, lost_is_wrong=True)


@tricky("2")
def foreign_units(rng) -> Trial:
    """Millinewtons, kilograms, micrometres and minutes under foreign names; drafted."""
    made = _sled(rng)
    language = int(rng.integers(4))
    names = [
        ("Zeit", "Reibkraft", "Normalkraft", "Weg"),
        ("Time", "Fx", "Fz", "Position"),
        ("Temps", "Force de frottement", "Force normale", "Position"),
        ("t", "Ft", "Fn", "Displacement"),
    ][language]
    per_second, clock = [(1.0, "s"), (1 / 60, "min"), (1e3, "ms")][rng.integers(3)]
    per_newton, force = [(1e3, "mN"), (1.0, "N"), (1e-3, "kN"), (1 / 9.80665, "kgf")][
        rng.integers(4)
    ]
    per_metre, length = [(1e6, "um"), (1e3, "mm"), (1e2, "cm")][rng.integers(3)]
    columns = [
        Column("time", names[0], clock, made.motion.time * per_second, ".9g"),
        Column("friction_force", names[1], force, made.friction * per_newton),
        Column("normal_force", names[2], force, made.normal * per_newton),
        Column("position", names[3], length, made.position * per_metre, ".9g"),
    ]
    how = {"delimiter": ";", "decimal": ","} if language in (0, 2) else {"delimiter": "\t"}
    return _one_file(columns, made.truth, text=table(columns, **how))


@tricky("2")
def rows_without_numbers(rng) -> Trial:
    """The logger writes OVL or nothing while the amplifier settles: 0.5 to 3 % of the rows."""
    made = _sled(rng)
    columns = _columns(made)
    lines = table(columns).splitlines()
    spoilt = np.sort(rng.integers(1, len(lines), int(rng.uniform(0.005, 0.03) * len(lines))))
    word = str(rng.choice(["OVL", "", "NaN", "---"]))
    for i in spoilt:
        cells = lines[i].split(",")
        lines[i] = ",".join([cells[0], word, *cells[2:]])
    return _one_file(columns, made.truth, text="\n".join(lines) + "\n", note=word)


@tricky("2")
def time_of_day(rng) -> Trial:
    """The time is written as on a clock, and midnight passes; drafted."""
    made = _sled(rng)
    start = 86400 - rng.uniform(20, 60)
    seconds = (start + made.motion.time) % 86400
    columns = _columns(made)
    lines = table(columns).splitlines()
    for i, now in enumerate(seconds, 1):
        stamp = f"{int(now // 3600):02d}:{int(now // 60 % 60):02d}:{now % 60:06.3f}"
        lines[i] = ",".join([stamp, *lines[i].split(",")[1:]])
    lines[0] = lines[0].replace("Time [s]", "Time")
    truth = replace(
        made.truth,
        start=made.truth.start + start,
        stop=made.truth.stop + start,
        time=made.truth.time + start,
    )
    return _one_file(columns, truth, text="\n".join(lines) + "\n", lost_is_wrong=True)


@tricky("2")
def epoch_milliseconds(rng) -> Trial:
    """The time counts milliseconds since 1970; drafted."""
    made = _sled(rng)
    columns = _columns(made)
    millis = np.round(1e3 * made.motion.time) + 1.78e12
    columns[0] = Column("time", "Timestamp", "ms", millis, ".0f")
    late = replace(
        made.truth,
        start=made.truth.start + 1.78e9,
        stop=made.truth.stop + 1.78e9,
        time=made.truth.time + 1.78e9,
    )
    return _one_file(columns, late, lost_is_wrong=True)


@tricky("2")
def negative_load(rng) -> Trial:
    """The load cell counts pressing as negative; unloaded rests scatter around zero; drafted."""
    made = _disc(rng)
    columns = _columns(made)
    columns[2] = replace(columns[2], values=-made.normal)
    return _one_file(columns, made.truth)


@tricky("2")
def steps_with_stamps(rng) -> Trial:
    """A block for each step with its own clock and the moment it started; the lab took pauses."""
    made = _sled(rng)
    time, step = _steps(made)
    columns = _columns(made, time)
    pauses = np.concatenate([[0], np.cumsum(rng.integers(5, 900, step[-1]))])[step - 1]
    first = made.motion.time - time
    text = ""
    for number in range(1, step[-1] + 1):
        part = [replace(c, values=c.values[step == number]) for c in columns]
        begun = float((first + pauses)[step == number][0])
        stamp = f"2026-03-02 {10 + int(begun // 3600):02d}:{int(begun // 60 % 60):02d}"
        text += f"Step {number}\nStarted {stamp}:{begun % 60:09.6f}\n" + table(part)
    toml = dialect(
        "other_lab",
        columns,
        preamble=[""],
        time="restart = \"continue\"\nstart_pattern = '^Started (.*)'\n"
        'start_format = "%Y-%m-%d %H:%M:%S.%f"',
    )
    toml = toml.replace("line = 2", BLOCKS).replace("[header]", "end = '^Step'\n[header]")
    middle = (made.truth.start + made.truth.stop) / 2
    late = np.interp(middle, made.motion.time, pauses)
    truth = replace(
        made.truth,
        start=made.truth.start + late,
        stop=made.truth.stop + late,
        time=made.truth.time + pauses,
    )
    return _one_file(columns, truth, toml, text=text, lost_is_wrong=True)


@tricky("1")
def turning_both_ways(rng) -> Trial:
    """A ring turns to and fro; the file gives signed 1/min and the torque as a force."""
    made = _sled(rng)
    unit = str(rng.choice(["1/min", "min-1", "U/min", "rpm", "Hz", "1/s"]))
    radius = rng.uniform(0.01, 0.1)
    turning = made.velocity / radius * PER_RADIAN[unit]
    columns = [*_columns(made)[:3], Column("rotation_speed", "n", unit, turning)]
    toml = dialect(
        "other_lab", columns, speed=f'source = "rotation"\nradius = "{1e3 * radius:.9g} mm"'
    )
    return _one_file(columns, made.truth, toml, note=unit)
