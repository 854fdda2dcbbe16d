"""Files whose numbers do not stand below a line of their names."""

from __future__ import annotations

import datetime as dt
from itertools import zip_longest
from pathlib import Path

import numpy as np

from tribolab.rig.files import FIRST_DAY
from tribolab.rig.layouts.kinds import LayoutKind, add_kind, there_and_back
from tribolab.rig.layouts.record import MeasuredRecord
from tribolab.rig.layouts.tables import (
    EUROPEAN,
    Cells,
    TableStyle,
    friction_of,
    header_line,
    normal_of,
    position_of,
    step_clock,
    written_rows,
)

_BARE = TableStyle(";", ",", "[]", "latin-1")


def _named_numbers(record: MeasuredRecord, folder: Path) -> Path:
    """Write what a microcontroller prints, as the monitor of its serial line keeps it."""
    columns = [Cells("t", "ms", 1e3 * record.motion.time, 0)]
    columns += [
        c._replace(name=n) for n, c in zip(("Ff", "Fn", "x"), _signals(record), strict=True)
    ]
    rows = (
        row.split(";")
        for row in written_rows(columns, _BARE).decode().replace(",", ".").splitlines()
    )
    start = FIRST_DAY.replace(hour=9)
    stamps = (start + dt.timedelta(seconds=s) for s in record.motion.time.tolist())
    lines = ["09:00:00.000 -> tribometer v0.7, t in ms, Ff in N, Fn in N, x in mm"]
    for stamp, row in zip(stamps, rows, strict=True):
        told = " ".join(f"{c.name}:{cell}" for c, cell in zip(columns, row, strict=True))
        lines.append(f"{stamp:%H:%M:%S}.{stamp.microsecond // 1000:03d} -> {told}")
    path = folder / "serial.txt"
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def _listed_columns(record: MeasuredRecord, folder: Path) -> Path:
    """Write a table whose columns are named one to a line above it."""
    columns = [Cells("Zeit", "s", record.motion.time), *_signals(record)]
    names = ("Zeit", "Reibkraft", "Normalkraft", "Weg")
    head = ["[Kanäle]"]
    head += [
        f"Kanal {k}={n};{c.unit}" for k, (n, c) in enumerate(zip(names, columns, strict=True), 1)
    ]
    text = "\n".join([*head, "[Daten]"]) + "\n"
    path = folder / "kanaele.dat"
    path.write_bytes(text.encode(_BARE.encoding) + written_rows(columns, _BARE))
    return path


def _side_by_side(record: MeasuredRecord, folder: Path) -> Path:
    """Write the steps of a run beside each other, each under the same names."""
    leg = record.motion.leg
    columns = [Cells("Time", "s", step_clock(record)), *_signals(record)]
    parts = [[c._replace(values=c.values[leg == n]) for c in columns] for n in np.unique(leg)]
    empty = ";" * (len(columns) - 1)
    tables = [written_rows(part, EUROPEAN).decode().splitlines() for part in parts]
    titles = ";".join(f"Step {n}{empty}" for n in range(1, len(parts) + 1))
    head = ";".join(header_line(part, EUROPEAN).strip() for part in parts)
    rows = [";".join(row) for row in zip_longest(*tables, fillvalue=empty)]
    path = folder / "beside.csv"
    path.write_text("\n".join([titles, head, *rows]) + "\n", EUROPEAN.encoding)
    return path


def _signals(record: MeasuredRecord) -> list[Cells]:
    return [friction_of(record), normal_of(record), position_of(record)]


for _kind in (
    LayoutKind(
        "named_numbers", "each number behind its name, times of day", there_and_back, _named_numbers
    ),
    LayoutKind(
        "listed_columns", "columns named one to a line above", there_and_back, _listed_columns
    ),
    LayoutKind("side_by_side", "steps beside each other", there_and_back, _side_by_side),
):
    add_kind(_kind)
