"""Consecutive binary records of one type, as described by a dialect."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable


def read_records(path: Path, record: np.dtype[np.void], offset: int) -> RawFile:
    """Read the records of a file.

    Parameters
    ----------
    path
        The file.
    record
        Type of a record.
    offset
        Bytes before the first record.

    Raises
    ------
    ReadError
        If the file is shorter than one record.
    """
    size = path.stat().st_size - offset
    if size < record.itemsize:
        raise ReadError(
            f"the file has {max(size, 0)} bytes behind its header, a record has {record.itemsize}",
            where=path,
        )
    rows = np.memmap(path, record, "r", offset, shape=size // record.itemsize)
    names = record.names or ()
    columns = tuple(RawColumn(name, None, rows[name], path=name) for name in names)
    return RawFile(path, "binary", (RawTable("", columns),))
