"""Files with what machines of known makers record, in tables whose titles are made up here."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from layouts.kinds import LayoutKind, add_kind, by_crank, there_and_back
from layouts.motion import Leg, carried_out
from layouts.record import MeasuredRecord, Sensors, recorded
from layouts.tables import (
    CSV,
    EUROPEAN,
    TABBED,
    Cells,
    friction_of,
    normal_of,
    position_of,
    time_of,
    write_table,
)
from tribolab.rig.laws import DryLaw


def _by_rig_of_high_frequency(seed: int) -> MeasuredRecord:
    """Rub for ten minutes at the mean speed of strokes of 1 mm at 50 Hz, a row a second."""
    motion = carried_out([Leg(2 * 1e-3 * 50, 600.0)], 1.0)
    sensors = Sensors(offset=0.0, normal_offset=0.0)
    return recorded(motion, DryLaw(0.2, 0.01), 0.2 * 9.80665, seed=seed, sensors=sensors)


def _hfrr(record: MeasuredRecord, folder: Path) -> Path:
    ratio = record.friction_force / record.normal_force
    columns = [time_of(record), Cells("Friction coefficient", "", ratio), *_film(record)]
    return write_table(folder / "hfrr.csv", columns, ["HFRR"], TABBED)


def _film(record: MeasuredRecord) -> list[Cells]:
    ones = np.ones(record.motion.time.size)
    return [Cells("Film", "%", 40 * ones, 0), Cells("Temperature", "°C", 60 * ones, 1)]


def _srv(record: MeasuredRecord, folder: Path) -> Path:
    head = ["Optimol SRV 4", "Stroke: 10,0 mm", "Frequency: 1 Hz", "Temperature: 50 °C"]
    columns = [time_of(record), normal_of(record, "Load"), friction_of(record)]
    return write_table(folder / "srv.csv", columns, head, EUROPEAN)


def _tribox(record: MeasuredRecord, folder: Path) -> Path:
    cycles = Cells("Cycles", "", record.motion.leg, 0)
    columns = [time_of(record), cycles, position_of(record)]
    columns += [normal_of(record, "Fn"), friction_of(record, "Ft")]
    return write_table(folder / "tribox.csv", columns, ["TriboX"], CSV)


add_kind(LayoutKind("optimol_srv", "SRV: stroke, frequency in the header", by_crank, _srv))
_SAID = "HFRR: one row per second, settings as in the standard"
add_kind(LayoutKind("pcs_hfrr", _SAID, _by_rig_of_high_frequency, _hfrr))
add_kind(LayoutKind("tribox", "TriboX: names Ft and Fn", there_and_back, _tribox))
