"""Reading of delimited text into float64 arrays, block by block, with little extra memory."""

from __future__ import annotations

import hashlib
import io
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from tribolab.arrays.scratch import is_long, let_go, room
from tribolab.core.errors import ReadError
from tribolab.reading.dialect.columns import ReadColumn
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
    """Block that is being parsed and hashed; its buffer is reused when both are done."""

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


_MIN_LINES = 5  # lines needed to recognise that every second one is empty


class GrowingColumns:
    """Arrays that grow block by block; numbers are converted to SI when stored.

    `size` is the number of bytes of the table, in `blocks` blocks; `of` that of all tables of the
    run.
    """

    def __init__(self, signals: list[ReadColumn], size: int, of: int, blocks: int):
        self._signals, self._size, self._blocks = signals, size, blocks
        self._parts = max(1.0, of / max(size, 1))  # ratio of the run's size to this table's size
        self._arrays: list[np.ndarray] = []
        self._used = 0

    def take(self, pieces: list[list[np.ndarray]]) -> None:
        """Append the pieces of one block."""
        rows = sum(len(piece) for piece in pieces[0])
        if rows == 0:
            return
        self._make_room(rows)
        for signal, array, chunks in zip(self._signals, self._arrays, pieces, strict=True):
            at = self._used
            for chunk in chunks:
                target = array[at : at + len(chunk)]
                with np.errstate(over="ignore"):  # a damaged number may overflow
                    if signal.scale == 1.0:
                        target[:] = chunk
                    else:
                        _scaled(chunk, signal.scale, target)
                    if signal.offset:
                        target += signal.offset
                at += len(chunk)
        self._used += rows
        let_go()

    def _make_room(self, rows: int) -> None:
        if not self._arrays:
            # allocated memory that is never used costs nothing, so the guess is high
            guess = max(rows, min(rows * (self._blocks + 2), self._size // 2 + 1))
            self._arrays = [self._room(guess) for _ in self._signals]
        if self._used + rows > len(self._arrays[0]):
            for k, array in enumerate(self._arrays):
                self._arrays[k] = self._room(max(2 * len(array), self._used + rows))
                self._arrays[k][: self._used] = array[: self._used]
                let_go()

    def _room(self, rows: int) -> np.ndarray:
        """Return an array of that many rows: in a scratch file for a long run, else from arrow.

        Numpy requests huge pages, which the system first clears if memory is fragmented.
        """
        of = int(rows * self._parts)
        return room(rows, of=of) if is_long(of) else np.frombuffer(pa.allocate_buffer(8 * rows))

    def finished(self) -> dict[str, np.ndarray]:
        """Return arrays by quantity, cut to the rows that were read."""
        arrays = self._arrays or [np.empty(0) for _ in self._signals]
        return {
            s.quantity: array[: self._used] for s, array in zip(self._signals, arrays, strict=True)
        }


def of_one_column(values: np.ndarray) -> np.ndarray:
    """Return the values of a single column without empty lines around them or after each value.

    Examples
    --------
    >>> of_one_column(np.array([np.nan, 1.0, np.nan, 3.0, 4.0, np.nan]))
    array([ 1., nan,  3.,  4.])
    >>> of_one_column(np.array([1.0, np.nan, 2.0, np.nan, 3.0, np.nan, 4.0]))
    array([1., 2., 3., 4.])
    """
    known = np.flatnonzero(np.isfinite(values))
    if not known.size:
        return values
    inner = values[known[0] : known[-1] + 1]
    is_double = inner.size > _MIN_LINES and inner.size == 2 * known.size - 1
    return inner[::2] if is_double and np.isfinite(inner[::2]).all() else inner


def _scaled(numbers: np.ndarray, scale: float, out: np.ndarray) -> None:
    """Multiply so that 49.703 mm is exactly 0.049703 m: division by 1000 rounds only once."""
    inverse = 1.0 / scale
    if abs(inverse) > 1.0 and abs(inverse - round(inverse)) < 1e-12 * abs(inverse):
        np.divide(numbers, float(round(inverse)), out=out)
    else:
        np.multiply(numbers, scale, out=out)
