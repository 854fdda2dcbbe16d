"""Delimited text into float64 arrays, block by block: memory stays near that of the result."""

from __future__ import annotations

import hashlib
import io
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, BinaryIO

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from tribolab.errors import ReadError
from tribolab.io.columns import Signal
from tribolab.io.dialect_model import Dialect
from tribolab.io.headers import RawText, Table

BLOCK = 4 << 20  # bytes: two of them in work fit the cache and keep both cores busy
_WORKERS = 2
_NO_VALUE = ["", "nan", "NaN", "NAN", "-nan", "null", "NULL", "N/A", "n/a", "NA", "--"]


class Hasher:
    """SHA-256 of a file, taken in a thread of its own from the bytes that are parsed anyway."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()
        self._thread = ThreadPoolExecutor(1)
        self._waiting: deque[Future] = deque()

    def update(self, data: bytes) -> None:
        """Add bytes; waits if the thread is far behind, so that blocks do not pile up."""
        self._waiting.append(self._thread.submit(self._digest.update, data))
        if len(self._waiting) > 2 * _WORKERS:
            self._waiting.popleft().result()

    def hexdigest(self) -> str:
        """Return the sum of all that was added."""
        self._thread.shutdown(wait=True)
        return self._digest.hexdigest()


def read_table(
    raw: RawText,
    table: Table,
    signals: list[Signal],
    dialect: Dialect,
    hasher: Hasher | None = None,
) -> tuple[dict[str, np.ndarray], int]:
    """Read the columns of one table, in SI.

    Parameters
    ----------
    raw, table
        The file and the table in it, from `tribolab.io.headers.find_tables`.
    signals
        The columns to read.
    dialect
        How the numbers are written.
    hasher
        Given every byte of the file in passing, those around the table too.

    Returns
    -------
    tuple
        Arrays by quantity (missing values are NaN), and the number of incomplete rows left out
        at the end of the table.

    Raises
    ------
    ReadError
        If a cell is no number or a row has the wrong number of cells.
    """
    parser = _Parser(raw, table, signals, dialect)
    columns = _Columns(signals, table.stop - table.start)
    waiting: deque[Future] = deque()
    with ThreadPoolExecutor(_WORKERS) as workers:
        for place, block, last in _blocks(raw, table, hasher):
            waiting.append(workers.submit(parser.parse, block, place, last))
            if len(waiting) > _WORKERS:
                columns.take(waiting.popleft().result())
        while waiting:
            columns.take(waiting.popleft().result())
    return columns.finished(), parser.incomplete


def _blocks(raw: RawText, table: Table, hasher: Hasher | None) -> Iterator[tuple[int, bytes, bool]]:
    """Whole lines of a table: offset, bytes, and whether they are the last."""
    if raw.memory is not None:
        yield from _cut(io.BytesIO(raw.memory), table, None)
        return
    try:
        with raw.file.path.open("rb") as file:
            if hasher:
                hasher.update(file.read(table.start))
            yield from _cut(file, table, hasher)
            while hasher and (rest := file.read(BLOCK)):
                hasher.update(rest)
    except OSError as error:
        raise ReadError(f"{raw.file.path}: the file cannot be read any more: {error}") from error


def _cut(file: BinaryIO, table: Table, hasher: Hasher | None) -> Iterator[tuple[int, bytes, bool]]:
    file.seek(table.start)
    place, left, rest = table.start, table.stop - table.start, b""
    while left > 0:
        data = file.read(min(BLOCK, left))
        if not data:
            break
        left -= len(data)
        if hasher:
            hasher.update(data)
        cut = data.rfind(b"\n") + 1 if left else len(data)
        if cut:
            block = rest + data[:cut] if rest else data[:cut]
            yield place, block, left == 0
            place, rest = place + len(block), data[cut:]
        else:
            rest += data
    if rest:
        yield place, rest, True


class _Parser:
    """Turns blocks of lines into arrow tables, and arrow's complaints into ours."""

    def __init__(self, raw: RawText, table: Table, signals: list[Signal], dialect: Dialect):
        self._raw, self._table, self._signals, self._dialect = raw, table, signals, dialect
        names = [str(index) for index in range(table.width)]
        self._wanted = [names[signal.index] for signal in signals]
        delimiter = dialect.text.delimiter
        self.incomplete = 0
        self._parse = {"delimiter": "\t" if delimiter == "whitespace" else delimiter}
        self._read = arrow_csv.ReadOptions(
            column_names=names, block_size=2 * BLOCK, use_threads=False
        )
        self._convert: dict[str, Any] = {
            "include_columns": list(dict.fromkeys(self._wanted)),
            "null_values": [*_NO_VALUE, *dialect.text.missing],
            "decimal_point": dialect.text.decimal,
            "check_utf8": False,
        }

    def parse(self, block: bytes, place: int, last: bool) -> list[list[np.ndarray]]:
        """Numbers of one block: for each signal its pieces, still in the file's unit."""
        types = {name: pa.float64() for name in self._wanted}
        try:
            table = self._arrow(block, types)
        except pa.ArrowInvalid as error:
            table = self._second_try(block, place, last, types, error)
        return [
            [piece.to_numpy(zero_copy_only=False) for piece in table[name].chunks]
            for name in self._wanted
        ]

    def _arrow(self, block: bytes, types: dict[str, Any]) -> pa.Table:
        return arrow_csv.read_csv(
            pa.BufferReader(block),
            read_options=self._read,
            parse_options=arrow_csv.ParseOptions(**self._parse),
            convert_options=arrow_csv.ConvertOptions(**self._convert, column_types=types),
        )

    def _second_try(
        self, block: bytes, place: int, last: bool, types: dict[str, Any], error: Exception
    ) -> pa.Table:
        """Leave out a file's last row if the logger was stopped in it; else say what is wrong."""
        if last:
            whole = block.rstrip(b"\r\n \t")
            cut = whole.rfind(b"\n") + 1
            if cut and self._cells(whole[cut:]) < self._table.width:
                try:
                    table = self._arrow(block[:cut], types)
                except pa.ArrowInvalid:
                    pass
                else:
                    self.incomplete = 1
                    return table
        raise ReadError(self._diagnosis(block, place, error)) from error

    def _cells(self, line: bytes) -> int:
        return line.count(self._parse["delimiter"].encode()) + 1

    def _diagnosis(self, block: bytes, place: int, error: Exception) -> str:
        """Name the first line of a block that cannot be read."""
        path = self._raw.file.path
        before = self._lines_before(place)
        lines = block.decode("utf-8", errors="replace").splitlines()
        delimiter, missing = self._parse["delimiter"], set(self._convert["null_values"])
        for number, line in enumerate(lines):
            if not line.strip():
                continue
            cells = [cell.strip().strip('"').strip() for cell in line.split(delimiter)]
            where = f"{path}: line {before + number + 1}"
            if len(cells) != self._table.width:
                return (
                    f"{where} has {len(cells)} cells where {self._table.width} are expected: "
                    f"'{line[:60]}'; if the table ends before it, say so in the dialect: "
                    "[text] end = '...'"
                )
            for signal in self._signals:
                cell = cells[signal.index]
                if cell not in missing and not _is_number(cell, self._dialect.text.decimal):
                    return (
                        f"{where}, column '{signal.label}': '{cell[:40]}' is not a number; if it "
                        f"stands for a missing value, say so in the dialect: [text] missing = "
                        f"['{cell[:40]}']"
                    )
        return f"{path}: the rows after line {before} cannot be read: {error}"

    def _lines_before(self, place: int) -> int:
        if self._raw.memory is not None:
            return self._raw.memory.count(b"\n", 0, place)
        with self._raw.file.path.open("rb") as file:
            return sum(
                file.read(min(BLOCK, place - start)).count(b"\n")
                for start in range(0, place, BLOCK)
            )


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.replace(decimal, ".") if decimal == "," else cell)
    except ValueError:
        return False
    return True


class _Columns:
    """Arrays that grow as blocks come in; each number is brought to SI as it is stored."""

    def __init__(self, signals: list[Signal], size: int):
        self._signals, self._size = signals, size
        self._arrays: list[np.ndarray] = []
        self._used = 0

    def take(self, pieces: list[list[np.ndarray]]) -> None:
        """Append one block's pieces."""
        rows = sum(len(piece) for piece in pieces[0])
        self._make_room(rows)
        for signal, array, chunks in zip(self._signals, self._arrays, pieces, strict=True):
            at = self._used
            for chunk in chunks:
                target = array[at : at + len(chunk)]
                if signal.scale == 1.0:
                    target[:] = chunk
                else:
                    _scaled(chunk, signal.scale, target)
                if signal.offset:
                    target += signal.offset
                at += len(chunk)
        self._used += rows

    def _make_room(self, rows: int) -> None:
        if not self._arrays:
            # what is allocated but never touched takes no memory, so guess high
            guess = max(rows, min(rows * (self._size // BLOCK + 2), self._size // 2 + 1))
            self._arrays = [np.empty(guess) for _ in self._signals]
        while self._used + rows > len(self._arrays[0]):
            for array in self._arrays:
                array.resize(max(2 * len(array), self._used + rows), refcheck=False)

    def finished(self) -> dict[str, np.ndarray]:
        """Arrays by quantity, cut to the rows that came."""
        for array in self._arrays:
            array.resize(self._used, refcheck=False)
        arrays = self._arrays or [np.empty(0) for _ in self._signals]
        return {s.quantity: array for s, array in zip(self._signals, arrays, strict=True)}


def _scaled(numbers: np.ndarray, scale: float, out: np.ndarray) -> None:
    """Multiply so that 49.703 mm is 0.049703 m: dividing by 1000 rounds once, times 0.001 twice."""
    inverse = 1.0 / scale
    if abs(inverse) > 1.0 and abs(inverse - round(inverse)) < 1e-12 * abs(inverse):
        np.divide(numbers, float(round(inverse)), out=out)
    else:
        np.multiply(numbers, scale, out=out)
