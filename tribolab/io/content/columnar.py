"""Runs in files that hold columns by name: Parquet, Feather, HDF5, MATLAB 7.3, Excel, records."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.errors import ReadError, shown
from tribolab.io.content.model import Content, Piece
from tribolab.io.dialects.columnar import layout_of, named
from tribolab.io.dialects.columns import resolve, scales_of, symbols
from tribolab.io.dialects.model import Dialect
from tribolab.io.tables.columnar import open_columns, seconds_of
from tribolab.provenance import sha256_of_file


def read_columnar(path: Path, dialect: Dialect) -> Content:
    """Read the columns of a file that names them.

    Parameters
    ----------
    path
        The file.
    dialect
        Its format, and which column is which quantity.

    Raises
    ------
    ReadError
        If the file is damaged, a column is missing or holds no numbers, or their lengths differ.
    """
    try:
        table = open_columns(path, dialect.format, layout_of(dialect))
        names, units = named(table)
        signals, unused = resolve(str(path), names, units, len(names), dialect)
        columns = {}
        for signal in signals:
            values = _numbers(path, signal.label, table.column(signal.place))
            with np.errstate(over="ignore", invalid="ignore"):  # damaged numbers may be anything
                columns[signal.quantity] = values * signal.scale + signal.offset
    except ReadError:
        raise
    except Exception as error:  # each of these libraries has its own ways to say "damaged"
        raise ReadError(
            f"this {dialect.format} file cannot be read: {shown(str(error), 200)}", where=path
        ) from error
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        raise ReadError(f"the columns differ in length: {sorted(lengths)}", where=path)
    labels = {s.quantity: f"{s.label} [{s.unit}]" for s in signals}
    own = symbols(signals, dialect)
    sha256 = sha256_of_file(path)
    pieces, scales = [Piece(columns, before=table.text)], scales_of(signals)
    return Content(path, sha256, pieces, labels, tuple(unused), symbols=own, scales=scales)


def _numbers(path: Path, label: str, values: np.ndarray) -> np.ndarray:
    if values.dtype.kind in "Mm":  # moments: seconds since 1970; or what has passed
        return seconds_of(values)
    if values.dtype.kind in "fiub":
        with np.errstate(invalid="ignore"):  # what is damaged is not a number
            return np.asarray(values, dtype=float)
    raise ReadError(f"column '{shown(label)}' holds no numbers", where=path)
