"""Files in which speed and friction follow from something else: turns, strokes, torques, volts."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from layouts.kinds import (
    LayoutKind,
    add_kind,
    by_crank,
    on_disc,
    on_disc_under_load,
    pulled,
    there_and_back,
)
from layouts.record import MeasuredRecord
from layouts.tables import (
    EUROPEAN,
    TABBED,
    Cells,
    friction_of,
    normal_of,
    position_of,
    time_of,
    write_table,
)

_RADIUS = 25e-3  # [m] of the track
_TURN = 2 * np.pi
_AREA = 100e-6  # [m2] of the nominal contact


def _turns(record: MeasuredRecord, unit: str = "rpm") -> Cells:
    return Cells("Rotation", unit, 60 * record.motion.velocity / _RADIUS / _TURN, 3)


def _rotary_steps(record: MeasuredRecord, folder: Path) -> Path:
    head = ["Rotary tribometer 2000", "Operator: A. Person", "Track radius: 25 mm"]
    step = Cells("Step", "", record.motion.leg, 0)
    columns = [step, time_of(record), _turns(record), friction_of(record), normal_of(record)]
    return write_table(folder / "disc.csv", columns, [*head, "Ball radius: 3 mm", ""])


def _stated_ratio(record: MeasuredRecord, folder: Path) -> Path:
    mean = Cells("Mean speed", "mm/s", 2e3 * record.motion.velocity, 3)
    columns = [time_of(record), mean, friction_of(record, "Traction force"), normal_of(record)]
    return write_table(folder / "ball_on_disc.txt", columns, ["SRR: 50 %"], TABBED)


def _unsaid(record: MeasuredRecord, folder: Path) -> Path:
    columns = [time_of(record), _turns(record), friction_of(record), normal_of(record)]
    return write_table(folder / "disc.csv", columns)


def _rotary_torque(record: MeasuredRecord, folder: Path) -> Path:
    torque = Cells("Torque", "N m", record.friction_force * _RADIUS, 6)
    columns = [
        time_of(record),
        torque,
        normal_of(record, "Axial load"),
        _turns(record, unit="1/min"),
    ]
    head = ["Torque tribometer", "Track radius: 25 mm"]
    return write_table(folder / "torque.csv", columns, head, EUROPEAN)


def _two_load_channels(record: MeasuredRecord, folder: Path) -> Path:
    low = Cells("Normal force", "N", np.zeros(record.motion.time.size), 3)
    columns = [time_of(record), _turns(record), friction_of(record), low, normal_of(record)]
    return write_table(folder / "pin_on_disc.csv", columns, ["Track radius: 25 mm"])


def _mini_traction(record: MeasuredRecord, folder: Path) -> Path:
    rolling = np.where(record.motion.velocity > 0, 0.4, 0.0)
    share = np.where(rolling > 0, record.motion.velocity / 0.4, 0.0)
    columns = [
        time_of(record),
        Cells("Rolling speed", "mm/s", 1e3 * rolling, 2),
        Cells("SRR", "%", 100 * share, 4),
        friction_of(record, "Traction force"),
        normal_of(record, "Ball load"),
    ]
    return write_table(folder / "traction.txt", columns, ["Traction machine"], TABBED)


def _stroke_settings(record: MeasuredRecord, folder: Path) -> Path:
    head = ["Reciprocating rig", "Stroke length: 10 mm", "Frequency: 1 Hz", "Drive: crank", ""]
    columns = [time_of(record), friction_of(record), normal_of(record)]
    return write_table(folder / "reciprocating.csv", columns, head)


def _crank_position(record: MeasuredRecord, folder: Path) -> Path:
    columns = [time_of(record), position_of(record), friction_of(record), normal_of(record)]
    return write_table(folder / "oscillating.csv", columns)


def _sled(record: MeasuredRecord, folder: Path) -> Path:
    head = ["Coefficient of friction test", "Sled mass: 200 g", "Test speed: 100 mm/min"]
    columns = [
        time_of(record),
        position_of(record, "Crosshead"),
        Cells("Load cell", "N", record.friction_force, 4),
    ]
    return write_table(folder / "sled.csv", columns, head)


def _voltages(record: MeasuredRecord, folder: Path) -> Path:
    columns = [
        time_of(record),
        Cells("Bridge tangential", "mV/V", record.friction_force / 12.5, 6),
        Cells("Bridge normal", "mV/V", record.normal_force / 20.0, 6),
        position_of(record, "Stage"),
    ]
    head = ["Excitation: 5 V", "Gain tangential: 12.5 N/(mV/V)", "Gain normal: 20 N/(mV/V)"]
    return write_table(folder / "bridges.csv", columns, head)


def _counts(record: MeasuredRecord, folder: Path) -> Path:
    columns = [
        time_of(record),
        Cells("adc0", "", np.round(record.friction_force / 50 * 2**15), 0),
        Cells("adc1", "", np.round(record.normal_force / 50 * 2**15), 0),
        Cells("enc", "", np.round(record.motion.position / 0.5e-6), 0),
    ]
    return write_table(folder / "counts.csv", columns)


def _stresses(record: MeasuredRecord, folder: Path) -> Path:
    columns = [
        time_of(record),
        Cells("Shear stress", "kPa", 1e-3 * record.friction_force / _AREA, 4),
        Cells("Normal stress", "kPa", 1e-3 * record.normal_force / _AREA, 4),
        Cells("Displacement", "um", 1e6 * record.motion.position, 3),
    ]
    return write_table(folder / "shear_cell.csv", columns)


def _blank(record: MeasuredRecord, folder: Path) -> Path:
    noise = np.random.default_rng(1).standard_normal(500)
    blank = [
        Cells("Time", "s", np.arange(500) / 50),
        Cells("Rotation", "rpm", np.full(500, 10.0), 3),
        Cells("Friction force", "N", record.friction_zero + 0.02 * noise),
        Cells("Normal force", "N", 0.01 * noise, 3),
    ]
    write_table(folder / "blank.csv", blank, ["Track radius: 25 mm"])
    columns = [time_of(record), _turns(record), friction_of(record), normal_of(record)]
    return write_table(folder / "disc.csv", columns, ["Track radius: 25 mm"])


_BRIDGES = """name = "bridges"
title = "strain bridges"
[header]
line = 4
units = "dialect"
[speed]
source = "position"
[[column]]
quantity = "time"
name = "Time (s)"
unit = "s"
[[column]]
symbol = "tangential"
name = "Bridge tangential (mV/V)"
unit = "mV/V"
[[column]]
symbol = "normal"
name = "Bridge normal (mV/V)"
unit = "mV/V"
[[column]]
quantity = "position"
name = "Stage (mm)"
unit = "mm"
[[value]]
name = "gain_tangential"
pattern = 'Gain tangential: (\\S+) N'
unit = "N/(mV/V)"
to = "N"
[[value]]
name = "gain_normal"
pattern = 'Gain normal: (\\S+) N'
unit = "N/(mV/V)"
to = "N"
[[derived]]
quantity = "friction_force"
formula = "tangential * gain_tangential"
[[derived]]
quantity = "normal_force"
formula = "normal * gain_normal"
"""

_COUNTS = """name = "counts"
title = "a board's counts"
[header]
line = 1
[speed]
source = "position"
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "friction_force"
name = "adc0"
scale = 0.00152587890625
unit = "N"
[[column]]
quantity = "normal_force"
name = "adc1"
scale = 0.00152587890625
unit = "N"
[[column]]
quantity = "position"
name = "enc"
scale = 0.5
unit = "um"
"""

_RADIUS_TYPED = (
    ('# radius = "? mm"', 'radius = "25 mm"'),
    ('# source = "rotation"', 'source = "rotation"'),
    ('source = "none"\n', "\n"),
)

for _name, _about, _run, _write in (
    ("rotary_steps", "disc: steps, radius in the header", on_disc, _rotary_steps),
    ("stated_ratio", "mean speed, slide-roll ratio in the header", on_disc, _stated_ratio),
    ("rotary_torque", "disc: torque and radius", on_disc, _rotary_torque),
    ("two_load_channels", "two load channels, one filled", on_disc, _two_load_channels),
    ("mini_traction", "rolling speed, slide-roll ratio", on_disc, _mini_traction),
    ("stroke_settings", "stroke, frequency in the header", by_crank, _stroke_settings),
    ("crank_position", "crank, position recorded", by_crank, _crank_position),
    ("sled", "sled, mass in the header", pulled, _sled),
    ("stresses", "stresses instead of forces", there_and_back, _stresses),
):
    add_kind(LayoutKind(_name, _about, _run, _write))
add_kind(LayoutKind("radius_unsaid", "disc, radius missing", on_disc, _unsaid, typed=_RADIUS_TYPED))
add_kind(
    LayoutKind("bridges", "strain bridges with gains", there_and_back, _voltages, dialect=_BRIDGES)
)
add_kind(LayoutKind("counts", "ADC counts", there_and_back, _counts, dialect=_COUNTS))
_FROM = "file blank.csv"
add_kind(LayoutKind("blank_run", "zero in a separate file", on_disc_under_load, _blank, zero=_FROM))
