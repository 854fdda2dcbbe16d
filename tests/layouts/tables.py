"""Tables as text: columns of fixed decimals under names, as loggers write them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from layouts.record import MeasuredRecord
from tribolab.rig.files import fixed_table


class Cells(NamedTuple):
    """A column: its name, its unit ("" for none), its numbers and their decimals."""

    name: str
    unit: str
    values: np.ndarray
    decimals: int = 4


class TableStyle(NamedTuple):
    """How a table is written; units stand in "[]", "()", or with "row" in the next line."""

    delimiter: str = ","
    decimal: str = "."
    units: str = "()"
    encoding: str = "utf-8"


CSV = TableStyle()
EUROPEAN = TableStyle(";", ",", "[]", "latin-1")
TABBED = TableStyle("\t", ".", "row")


def header_line(columns: Sequence[Cells], style: TableStyle) -> str:
    """Return the line (or two) of names and units."""
    if style.units == "row":
        rows = [[c.name for c in columns], [c.unit for c in columns]]
        return "\n".join(style.delimiter.join(row) for row in rows) + "\n"
    left, right = style.units[0], style.units[1]
    named = (f"{c.name} {left}{c.unit}{right}" if c.unit else c.name for c in columns)
    return style.delimiter.join(named) + "\n"


def written_rows(columns: Sequence[Cells], style: TableStyle) -> bytes:
    """Return the lines of numbers."""
    body = fixed_table([(c.values, c.decimals) for c in columns], style.delimiter)
    return body if style.decimal == "." else body.replace(b".", style.decimal.encode())


def write_table(
    path: Path, columns: Sequence[Cells], head: Sequence[str] = (), style: TableStyle = CSV
) -> Path:
    """Write a table below some lines of text."""
    text = "".join(f"{line}\n" for line in head) + header_line(columns, style)
    path.write_bytes(text.encode(style.encoding) + written_rows(columns, style))
    return path


def time_of(record: MeasuredRecord) -> Cells:
    """Return the time in seconds."""
    return Cells("Time", "s", record.motion.time)


def friction_of(record: MeasuredRecord, name: str = "Friction force") -> Cells:
    """Return the friction force in N."""
    return Cells(name, "N", record.friction_force)


def normal_of(record: MeasuredRecord, name: str = "Normal force") -> Cells:
    """Return the normal force in N."""
    return Cells(name, "N", record.normal_force, 3)


def position_of(record: MeasuredRecord, name: str = "Position") -> Cells:
    """Return the position in mm."""
    return Cells(name, "mm", 1e3 * record.motion.position, 5)


def step_clock(record: MeasuredRecord) -> np.ndarray:
    """Return the time since the step began [s]."""
    time, leg = record.motion.time, record.motion.leg
    first = np.searchsorted(leg, leg, side="left")
    return time - time[first]
