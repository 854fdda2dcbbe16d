"""Reading of delimited text into float64 arrays, block by block, with little extra memory."""

from __future__ import annotations

import hashlib
import io
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.columns import ReadColumn
from tribolab.reading.dialect.delimited.growing_columns import GrowingColumns, of_one_column
from tribolab.reading.dialect.delimited.headers import LONGEST_LINE
from tribolab.reading.dialect.delimited.rows import RowParser
from tribolab.reading.dialect.delimited.tables import RawText, TextTable
from tribolab.reading.dialect.model import Dialect

_BLOCK = 4 << 20  # bytes; small blocks reuse memory, but each costs arrow a thread
_WORKERS = 2
_DEPTH = 4  # blocks in work or waiting, so that no worker is idle while one is stored


class Hasher:
    """SHA-256 of a file, computed in a separate thread from the bytes being parsed."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()
        self._thread = ThreadPoolExecutor(1)

    def update(self, data: bytes | memoryview) -> Future[None]:
        """Add bytes; they may be overwritten after the future is done."""
        return self._thread.submit(self._digest.update, data)

    def hexdigest(self) -> str:
        """Return the checksum of all added bytes."""
        self._thread.shutdown(wait=True)
        return self._digest.hexdigest()


class _Work(NamedTuple):
    """Block in work; its buffer is reused when both futures are done."""

    buffer: bytearray
    parsed: Future[list[list[np.ndarray]]]
    hashed: Future[None] | None


def read_table(
    raw: RawText,
    table: TextTable,
    signals: list[ReadColumn],
    dialect: Dialect,
    hasher: Hasher | None = None,
    size: int = 0,
) -> tuple[dict[str, np.ndarray], int]:
    """Read the columns of one table, in SI.

    Parameters
    ----------
    raw, table
        The file and the table in it, from `tribolab.reading.dialect.delimited.tables.find_tables`.
    signals
        The columns to read.
    dialect
        Format of the numbers.
    hasher
        Receives every byte of the file, including those outside the table.
    size
        Bytes of all tables of the run, if it has more than this one.

    Returns
    -------
    tuple
        Arrays by quantity (missing values are NaN), and the number of incomplete rows left out
        at the end of the table.

    Raises
    ------
    ReadError
        If a cell is not a number or a row has the wrong number of cells.
    """
    parser = RowParser(raw, table, signals, dialect)
    long = table.stop - table.start
    columns = GrowingColumns(signals, long, size, long // _BLOCK)
    try:
        with _opened(raw) as file, ThreadPoolExecutor(_WORKERS) as workers:
            if hasher:
                hasher.update(file.read(table.start))
            _pump(file, table, parser, columns, workers, hasher)
            while hasher and (rest := file.read(_BLOCK)):
                hasher.update(rest).result()
    except OSError as error:
        raise ReadError(f"{raw.file.path}: the file cannot be read any more: {error}") from error
    finished = columns.finished()
    if table.width == 1:
        finished = {name: of_one_column(values) for name, values in finished.items()}
    return finished, parser.incomplete


def _opened(raw: RawText) -> io.FileIO | io.BytesIO:
    return raw.file.path.open("rb", buffering=0) if raw.memory is None else io.BytesIO(raw.memory)


def _pump(
    file: io.FileIO | io.BytesIO,
    table: TextTable,
    parser: RowParser,
    columns: GrowingColumns,
    workers: ThreadPoolExecutor,
    hasher: Hasher | None,
) -> None:
    """Feed a table to the parser in blocks of whole lines, with a few reused buffers."""
    file.seek(table.start)
    place, left, rest = table.start, table.stop - table.start, b""
    block = min(_BLOCK, left // _WORKERS + 1)  # a small table is also shared between the workers
    free: list[bytearray] = []
    waiting: deque[_Work] = deque()

    def finish_one() -> None:
        work = waiting.popleft()
        columns.take(work.parsed.result())
        if work.hashed is not None:
            work.hashed.result()
        free.append(work.buffer)

    while left > 0:
        wanted = min(block, left)
        buffer = free.pop() if free else bytearray(len(rest) + block)
        if len(buffer) < len(rest) + wanted:
            buffer = bytearray(len(rest) + wanted)
        view = memoryview(buffer)
        view[: len(rest)] = rest
        got = file.readinto(view[len(rest) : len(rest) + wanted]) or 0
        left = left - got if got else 0
        full = len(rest) + got
        hashed = hasher.update(view[len(rest) : full]) if hasher else None
        cut = buffer.rfind(b"\n", 0, full) + 1 if left else full
        rest = bytes(view[cut:full])
        waiting.append(
            _Work(buffer, workers.submit(parser.parse, view[:cut], place, not left), hashed)
        )
        place += cut
        if len(rest) > LONGEST_LINE:
            raise parser.endless(place)
        if len(waiting) > _DEPTH:
            finish_one()
    while waiting:
        finish_one()
