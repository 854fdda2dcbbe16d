"""LabVIEW TDMS: channels in groups are columns; a group of marks may divide the run into steps."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.errors import ReadError, shown
from tribolab.io.content.model import Content, Piece
from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.columns import resolve, scales_of, symbols
from tribolab.io.dialects.layout import Marks
from tribolab.io.dialects.model import Dialect
from tribolab.io.dialects.patterns import guarded
from tribolab.io.tables.tdms_file import TdmsContent, on_one_grid, open_tdms, text_beside
from tribolab.provenance import sha256_of_file
from tribolab.units import conversion


def read_tdms(path: Path, dialect: Dialect) -> Content:
    """Read a TDMS file's channels, and its marks as steps.

    Parameters
    ----------
    path
        The file.
    dialect
        Which channel is which quantity.

    Raises
    ------
    ReadError
        If the file is damaged, or channels are missing or differ in length.
    """
    file = open_tdms(path)
    groups = {column.group for column in dialect.column}
    channels = [c for g in file.groups if g.name in groups for c in g.channels]
    named = [split_name(channel.name) for channel in channels]
    names, units = [n for n, _ in named], [u for _, u in named]
    signals, unused = resolve(str(path), names, units, len(names), dialect)
    grid = on_one_grid([channels[s.place] for s in signals]) if dialect.time.rate_pattern else None
    columns = {}
    for number, signal in enumerate(signals):
        numbers = grid.values[number] if grid else channels[signal.place].values
        if numbers.dtype.kind not in "fiu":
            raise ReadError(f"{path}: channel '{shown(signal.label)}' holds no numbers")
        with np.errstate(over="ignore", invalid="ignore"):  # damaged numbers may be anything
            columns[signal.quantity] = numbers * signal.scale + signal.offset
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        raise ReadError(f"{path}: the channels differ in length: {sorted(lengths)}")
    read = [group for group in file.groups if group.name in groups]
    text = text_beside(file, read, grid.increment if grid else 0.0)
    notes = {}
    if file.incomplete:
        notes["file_incomplete"] = "the file ends before its last segment does"
    if dialect.marks is not None:
        columns["step"], more = _steps(path, file, columns["time"], dialect.marks)
        notes |= more
    labels = {signal.quantity: f"{signal.label} [{signal.unit}]" for signal in signals}
    piece = Piece(columns, before=text)
    own = symbols(signals, dialect)
    sha256 = sha256_of_file(path)
    scales = scales_of(signals)
    return Content(path, sha256, [piece], labels, tuple(unused), {}, notes, own, scales)


def _steps(
    path: Path, file: TdmsContent, time: np.ndarray, marks: Marks
) -> tuple[np.ndarray, dict[str, str]]:
    """Step k lasts from mark k to mark k + 1; before the first mark it is 0."""
    group = next((g for g in file.groups if g.name == marks.group), None)
    clocks = [] if group is None else group.channels
    clocks = [channel for channel in clocks if split_name(channel.name)[0] == marks.time]
    if group is None or not clocks:
        raise ReadError(
            f"{path}: there is no channel '{shown(marks.time)}' in a group '{shown(marks.group)}'"
        )
    unit = marks.unit or split_name(clocks[0].name)[1]
    if unit is None:
        raise ReadError(
            f"{path}: the marks' time has no unit; give it in the dialect: [marks] unit"
        )
    scale, _ = conversion(unit, "s")
    at = np.sort(np.asarray(clocks[0].values, dtype=float) * scale)
    texts = [
        str(value)
        for key, value in group.properties.items()
        if marks.labels and guarded(marks.labels).search(key)
    ]
    notes = {"step_labels": "; ".join(texts)} if texts else {}
    return np.searchsorted(at, time, side="right").astype(float), notes
