"""Files whose clock or whose text is peculiar."""

from __future__ import annotations

import datetime as dt
import gzip
from pathlib import Path

import numpy as np

from layouts.kinds import LayoutKind, add_kind, there_and_back
from layouts.record import MeasuredRecord
from layouts.tables import (
    CSV,
    EUROPEAN,
    TABBED,
    Cells,
    TableStyle,
    friction_of,
    header_line,
    normal_of,
    position_of,
    step_clock,
    time_of,
    write_table,
    written_rows,
)
from tribolab.rig.files import FIRST_DAY

_RATE = 50.0  # [Hz]
_COUNTED = 4096  # rows that a counter holds


def _signals(record: MeasuredRecord) -> list[Cells]:
    return [friction_of(record), normal_of(record), position_of(record)]


def _european(record: MeasuredRecord, folder: Path) -> Path:
    columns = [
        Cells("Zeit", "s", record.motion.time),
        friction_of(record, "Reibkraft"),
        normal_of(record, "Normalkraft"),
        position_of(record, "Weg"),
    ]
    head = ["Prüfstand 3", "Prüfer: M. Müller", "Bemerkung: trocken, 20 °C"]
    return write_table(folder / "versuch.csv", columns, head, EUROPEAN)


def _compressed(record: MeasuredRecord, folder: Path) -> Path:
    path = _european(record, folder)
    packed = folder / "versuch.csv.gz"
    packed.write_bytes(gzip.compress(path.read_bytes()))
    path.unlink()
    return packed


def _units_below(record: MeasuredRecord, folder: Path) -> Path:
    columns = [time_of(record), *_signals(record)]
    return write_table(folder / "linear.txt", columns, ["Linear rig"], TABBED)


def _blocks(record: MeasuredRecord, folder: Path) -> Path:
    parts = []
    since, leg = step_clock(record), record.motion.leg
    columns = [Cells("Time", "s", since), *_signals(record)]
    for number in np.unique(leg):
        part = [c._replace(values=c.values[leg == number]) for c in columns]
        head = f"Step {number}\n".encode() + header_line(part, CSV).encode()
        parts.append(head + written_rows(part, CSV))
    path = folder / "steps.csv"
    path.write_bytes(b"\n".join(parts))
    return path


def _restarting(record: MeasuredRecord, folder: Path) -> Path:
    step = Cells("Step", "", record.motion.leg, 0)
    columns = [step, Cells("Step time", "s", step_clock(record)), *_signals(record)]
    return write_table(folder / "steps_in_one.csv", columns)


def _counter(record: MeasuredRecord, folder: Path) -> Path:
    rows = np.arange(record.motion.time.size)
    columns = [Cells("Sample", "", rows % _COUNTED, 0), *_signals(record)]
    return write_table(folder / "counter.csv", columns, ["Sampling rate: 50 Hz"])


def _rate(record: MeasuredRecord, folder: Path) -> Path:
    head = ["Data logger", "Sampling rate: 50 Hz", "Channels: 3"]
    return write_table(folder / "logger.csv", _signals(record), head)


def _intervals(record: MeasuredRecord, folder: Path) -> Path:
    passed = np.diff(record.motion.time, prepend=0.0)
    columns = [Cells("dt", "ms", 1e3 * passed, 3), *_signals(record)]
    return write_table(folder / "intervals.csv", columns)


def _moments(record: MeasuredRecord, form: str) -> list[str]:
    start = FIRST_DAY.replace(hour=23, minute=59, second=30)
    moments = (start + dt.timedelta(seconds=s) for s in record.motion.time.tolist())
    return [moment.strftime(form) for moment in moments]


def _dated(
    record: MeasuredRecord, path: Path, name: str, texts: list[str], style: TableStyle
) -> Path:
    columns = _signals(record)
    rows = written_rows(columns, style).decode().splitlines()
    lines = (f"{text}{style.delimiter}{row}" for text, row in zip(texts, rows, strict=True))
    head = f"{name}{style.delimiter}{header_line(columns, style)}"
    path.write_text(head + "\n".join(lines) + "\n", encoding=style.encoding)
    return path


def _time_of_day(record: MeasuredRecord, folder: Path) -> Path:
    return _dated(record, folder / "day.csv", "Time", _moments(record, "%H:%M:%S.%f"), CSV)


def _iso(record: MeasuredRecord, folder: Path) -> Path:
    texts = [f"{text}+01:00" for text in _moments(record, "%Y-%m-%dT%H:%M:%S.%f")]
    return _dated(record, folder / "iso.csv", "Timestamp", texts, CSV)


def _german_dates(record: MeasuredRecord, folder: Path) -> Path:
    texts = [text[:-3] for text in _moments(record, "%d.%m.%Y %H:%M:%S,%f")]
    return _dated(record, folder / "datum.csv", "Datum", texts, EUROPEAN)


for _kind in (
    LayoutKind(
        "european", "semicolons, decimal commas, Latin-1, German", there_and_back, _european
    ),
    LayoutKind("compressed", "the same, compressed (gz)", there_and_back, _compressed),
    LayoutKind("units_below", "tabs, units in the second line", there_and_back, _units_below),
    LayoutKind("blocks", "a header at each step, clock restarts", there_and_back, _blocks),
    LayoutKind(
        "restarting", "clock restarts at each step of one table", there_and_back, _restarting
    ),
    LayoutKind("counter", "row counter that wraps, rate in the header", there_and_back, _counter),
    LayoutKind("rate", "no time, rate in the header", there_and_back, _rate),
    LayoutKind("intervals", "time intervals to be summed", there_and_back, _intervals),
    LayoutKind("time_of_day", "time of day, over midnight", there_and_back, _time_of_day),
    LayoutKind("iso", "ISO dates with zone", there_and_back, _iso),
    LayoutKind("german_dates", "German dates", there_and_back, _german_dates),
):
    add_kind(_kind)
