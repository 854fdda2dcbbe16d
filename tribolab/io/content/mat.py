"""MAT files (MATLAB 5 to 7): each variable is a column."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.errors import ReadError, shown
from tribolab.io.content.model import Content, Piece
from tribolab.io.dialects.columns import resolve, scales_of, symbols
from tribolab.io.dialects.held_tables import settings_text
from tribolab.io.dialects.model import Dialect
from tribolab.io.tables.mat5 import read_variables
from tribolab.provenance import sha256_of_file


def read_mat(path: Path, dialect: Dialect) -> Content:
    """Read a MAT file's columns.

    Parameters
    ----------
    path
        The file.
    dialect
        Which variable is which quantity.

    Raises
    ------
    ReadError
        If the file is damaged, a variable is missing, or their lengths differ.
    """
    variables = read_variables(path)
    content = {variable.name: variable.numbers for variable in variables}
    names = list(content)
    signals, unused = resolve(str(path), names, [None] * len(names), len(names), dialect)
    columns = {}
    for signal in signals:
        numbers = content[names[signal.place]]
        if numbers is None or numbers.size != max(numbers.shape):
            raise ReadError(
                f"{path}: variable '{shown(signal.label)}' is not one column of numbers"
            )
        values = numbers.ravel().astype(float)
        with np.errstate(over="ignore", invalid="ignore"):  # what is damaged is not a number
            columns[signal.quantity] = values * signal.scale + signal.offset
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        raise ReadError(f"{path}: the variables differ in length: {sorted(lengths)}")
    labels = {signal.quantity: f"{signal.label} [{signal.unit}]" for signal in signals}
    pieces = [Piece(columns, before=settings_text(variables))]
    sha256 = sha256_of_file(path)
    own, scales = symbols(signals, dialect), scales_of(signals)
    return Content(path, sha256, pieces, labels, tuple(unused), symbols=own, scales=scales)
