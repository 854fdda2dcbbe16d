"""Reading of one raw file: one table for each of the instrument's steps, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar

import numpy as np

from tribolab.arrays.chunks import anywhere
from tribolab.core.errors import ReadError, shown
from tribolab.core.provenance import sha256_of_file
from tribolab.reading.dialect.columns import AGAIN, first_filled, resolve, scales_of, symbols
from tribolab.reading.dialect.containers import PythonReader
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.text_form import as_written
from tribolab.reading.raw.missing_marks import beyond_range, measurable, take_marks
from tribolab.reading.si_tables.model import Content, Piece
from tribolab.reading.si_tables.steps import last_match, started
from tribolab.reading.text.first_bytes import File, fits_format, peek

_T = TypeVar("_T")
_UNCLEAR = 0.5  # least |minimum|/maximum (or inverse) of a load whose sign is unclear
_PLACES = ("x", "y")  # coordinates of a scan, checked by `scan_grid`
_OF_NAMES = 3  # largest number of lines before the numbers if there is no preamble


def read_content(path: Path, dialect: Dialect, size: int = 0) -> Content:
    """Read one raw file with the dialect of its instrument.

    Parameters
    ----------
    path
        The file.
    dialect
        The instrument's dialect.
    size
        Bytes of all files of the run, if it has more than one.

    Returns
    -------
    Content
        The pieces, with label and unit of each quantity in the file, and the unused columns.

    Raises
    ------
    ReadError
        If the file does not match the dialect.
    """
    if isinstance(dialect, PythonReader):
        # imported late for a quick start
        from tribolab.reading.si_tables.containers import read_columns

        return _clean(read_columns(path, dialect), dialect)
    file = peek(path, binary=dialect.format == "binary")
    if not fits_format(file.format, dialect.format):
        raise ReadError(
            f"{path}: this is a {file.format} file, instrument '{dialect.name}' writes "
            f"{dialect.format}"
        )
    dialect = as_written(file, dialect)
    if dialect.format != "text":
        # imported late for a quick start
        from tribolab.reading.si_tables.containers import read_columns

        content = read_columns(file.path, dialect)
    else:
        content = _read_text(file, dialect, size)
    if file.path != path:  # it was decompressed
        content = content._replace(path=path, sha256=sha256_of_file(path))
    return _clean(content, dialect)


def _read_text(file: File, dialect: Dialect, size: int) -> Content:
    # imported late for a quick start
    from tribolab.reading.dialect.delimited.read_text import Hasher, read_table
    from tribolab.reading.dialect.delimited.tables import find_tables, foot_of, rows_outside

    raw = find_tables(file, dialect)
    whole = raw.memory is None and len(raw.tables) == 1
    hasher = Hasher() if whole else None
    pieces: list[Piece] = []
    labels: dict[str, str] = {}
    own: dict[str, str] = {}
    scales: dict[str, tuple[float, float]] = {}
    unused: dict[str, None] = {}
    cut = 0
    for table in raw.tables:
        where = f"{file.path}" if len(raw.tables) == 1 else f"{file.path}: line {table.line}"
        signals, not_used = resolve(where, table.names, table.units, table.width, dialect)
        columns, incomplete = read_table(raw, table, signals, dialect, hasher, size)
        cut += incomplete
        labels.update({s.quantity: f"{s.label} [{s.unit}]" for s in signals})
        unused.update(dict.fromkeys(not_used))
        own.update(symbols(signals, dialect))
        scales.update(scales_of(signals))
        step = last_match(dialect.header.step, table.before) if dialect.header.step else None
        if step is None and dialect.header.repeats:
            step = str(len(pieces) + 1)
        pieces.append(
            Piece(
                columns,
                _whole_number(file.path, step),
                started(table.before, file.path, dialect),
                table.before,
            )
        )
    sha256 = hasher.hexdigest() if hasher else sha256_of_file(file.path)
    outside = rows_outside(raw, dialect.text.delimiter)
    left_out = {"cut short at the end": cut, "outside of the table that is read": outside}
    left_out = {reason: count for reason, count in left_out.items() if count}
    begins = len(pieces) == 1 and pieces[0].before.strip().count("\n") < _OF_NAMES
    foot = foot_of(raw, dialect) if begins else ""
    return Content(
        file.path, sha256, pieces, labels, tuple(unused), left_out, {}, own, scales, foot
    )


def _no_value(values: np.ndarray) -> bool:
    return not anywhere(lambda part: ~np.isnan(part), values)


def _clean(content: Content, dialect: Dialect) -> Content:
    """Remove sentinels, impossible numbers and empty optional columns; set the sign of the load."""
    content = _orient_load(_choose_columns(_remove_impossible(_remove_sentinels(content))), dialect)
    rows = sum(len(next(iter(piece.columns.values()))) for piece in content.pieces)
    if rows == 0:
        raise ReadError(f"{content.path}: the file has a header, but no row of numbers below it")
    optional = {column.key for column in dialect.column if column.optional}
    present = dict.fromkeys(name for piece in content.pieces for name in piece.columns)
    empty = [
        name
        for name in present
        if all(_no_value(piece.columns[name]) for piece in content.pieces if name in piece.columns)
    ]
    for name in empty:
        if name not in optional:
            raise ReadError(
                f"{content.path}: column '{shown(content.labels[name])}' ({name}) has no value "
                "in any row; if that is so in good files too, say optional = true in the dialect "
                f"'{dialect.name}'"
            )
    pieces = [
        piece._replace(columns={k: v for k, v in piece.columns.items() if k not in empty})
        for piece in content.pieces
    ]
    without = tuple(f"{content.labels[name]} (no values)" for name in empty)
    return content._replace(pieces=pieces, not_used=content.not_used + without)


def _orient_load(content: Content, dialect: Dialect) -> Content:
    """Set the sign of a load of unknown sign such that its largest magnitude is positive."""
    if not any(column.sign == "pressed" for column in dialect.column):
        return content
    parts = [p.columns["normal_force"] for p in content.pieces if "normal_force" in p.columns]
    low = min((float(np.nanmin(part)) for part in parts if not _no_value(part)), default=0.0)
    high = max((float(np.nanmax(part)) for part in parts if not _no_value(part)), default=0.0)
    if min(-low, high) > _UNCLEAR * max(-low, high):
        raise ReadError(
            f"column '{shown(content.labels['normal_force'])}' (normal_force) is as far below zero "
            f"as above, so that its sign is unknown; say sign = 1 or sign = -1 in a copy of "
            f"the dialect '{dialect.name}'",
            where=content.path,
        )
    if -low <= high:
        return content
    pieces = [
        piece._replace(columns={**piece.columns, "normal_force": -piece.columns["normal_force"]})
        if "normal_force" in piece.columns
        else piece
        for piece in content.pieces
    ]
    return content._replace(pieces=pieces)


def _choose_columns(content: Content) -> Content:
    """Keep only the first filled column of several columns for one quantity."""
    keys = dict.fromkeys(key for piece in content.pieces for key in piece.columns)
    parts = {
        key: [piece.columns[key] for piece in content.pieces if key in piece.columns]
        for key in keys
    }
    chosen = first_filled(parts)
    if not chosen:
        return content
    pieces = [piece._replace(columns=_renamed(piece.columns, chosen)) for piece in content.pieces]
    left = [key for key in keys if key.split(AGAIN)[0] in chosen and key not in chosen.values()]
    unused = tuple(f"{content.labels[key]} (another column is filled)" for key in left)
    labels = _renamed(content.labels, chosen)
    return content._replace(pieces=pieces, labels=labels, not_used=content.not_used + unused)


def _renamed(columns: Mapping[str, _T], chosen: Mapping[str, str]) -> dict[str, _T]:
    """Name the chosen columns after their quantities, and leave out the others."""
    kept = {
        key: value for key, value in columns.items() if chosen.get(key.split(AGAIN)[0], key) == key
    }
    return {key.split(AGAIN)[0]: value for key, value in kept.items()}


def _remove_sentinels(content: Content) -> Content:
    """Replace sentinels (no-data values) by NaN, and note them."""
    marks_text = []
    for name in dict.fromkeys(name for piece in content.pieces for name in piece.columns):
        if name in ("time", *_PLACES):
            continue
        parts = [piece.columns[name] for piece in content.pieces if name in piece.columns]
        if all(part.dtype.kind == "f" and part.flags.writeable for part in parts):
            marks = take_marks(parts, *content.scales.get(name, (1.0, 0.0)))
            marks_text += [f"{name}: {mark.words}" for mark in marks]
    if not marks_text:
        return content
    return content._replace(notes={**content.notes, "taken_for_missing": "; ".join(marks_text)})


def _remove_impossible(content: Content) -> Content:
    """Replace physically impossible numbers by NaN, and note their count."""
    places: dict[str, int] = {}
    pieces = []
    for piece in content.pieces:
        columns = dict(piece.columns)
        for name, values in columns.items():
            if name in _PLACES or values.dtype.kind != "f":
                continue
            if name == "time":  # an error follows later, when the clock is evaluated
                columns[name] = _limit_times(values)
                continue
            columns[name] = measurable(values)
            if columns[name] is values:
                continue
            if odd := int(beyond_range(values).sum()):
                places[name] = places.get(name, 0) + odd
        pieces.append(piece._replace(columns=columns))
    content = content._replace(pieces=pieces)
    if not places:
        return content
    counts = "; ".join(f"{name}: {count}" for name, count in places.items())
    return content._replace(notes={**content.notes, "numbers_beyond_range": counts})


def _limit_times(values: np.ndarray) -> np.ndarray:
    """Replace times that no clock can show by infinity."""
    if not anywhere(beyond_range, values):
        return values
    return np.where(beyond_range(values), np.inf, values)


def _whole_number(path: Path, text: str | None) -> int | None:
    if text is None:
        return None
    try:
        return int(text)
    except ValueError as error:
        raise ReadError(f"{path}: '{shown(text)}' is no number of a step (header.step)") from error
