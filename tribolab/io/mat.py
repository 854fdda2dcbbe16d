"""MAT files (MATLAB 4 to 7): each variable is a column."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Any

import numpy as np

from tribolab.errors import ReadError
from tribolab.io.columns import resolve
from tribolab.io.dialect_model import Dialect
from tribolab.io.pieces import Content, Piece
from tribolab.provenance import sha256_of_file

# What scipy raises on a MAT file that is cut short or damaged.
_DAMAGE = (ValueError, TypeError, KeyError, OSError, EOFError, NotImplementedError, zlib.error)


def variable_names(path: Path) -> set[str]:
    """Names of the variables in a MAT file.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    from scipy.io import whosmat

    return {name for name, _, _ in _guarded(path, whosmat)}


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
    from scipy.io import loadmat

    content = {k: v for k, v in _guarded(path, loadmat).items() if not k.startswith("__")}
    names = list(content)
    signals, unused = resolve(str(path), names, [None] * len(names), len(names), dialect)
    columns = {}
    for signal in signals:
        numbers = np.asarray(content[names[signal.index]])
        if numbers.dtype.kind not in "fiu" or numbers.size != max(numbers.shape, default=0):
            raise ReadError(f"{path}: variable '{signal.label}' is not one column of numbers")
        columns[signal.quantity] = numbers.ravel() * signal.scale + signal.offset
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        raise ReadError(f"{path}: the variables differ in length: {sorted(lengths)}")
    labels = {signal.quantity: f"{signal.label} [{signal.unit}]" for signal in signals}
    return Content(path, sha256_of_file(path), [Piece(columns)], labels, tuple(unused))


def _guarded(path: Path, function: Any) -> Any:
    try:
        return function(str(path))
    except _DAMAGE as error:
        raise ReadError(f"{path}: the MAT file is damaged or of version 7.3: {error}") from error
