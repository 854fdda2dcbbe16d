"""Delimited text into float64 arrays, block by block: memory stays near that of the result."""

from __future__ import annotations

import hashlib
import io
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from tribolab.errors import ReadError, shown
from tribolab.io.dialects.columns import ReadColumn
from tribolab.io.dialects.dates import seconds
from tribolab.io.dialects.headers import LONGEST_LINE, RawText, Table, endless
from tribolab.io.dialects.model import Dialect
from tribolab.room import is_long, let_go, room
from tribolab.untyped import Arguments

BLOCK = 4 << 20  # bytes: small, so that memory is used again; but each block costs arrow a thread
_WORKERS = 2
_DEPTH = 4  # blocks in work or waiting, so that no worker is idle while one is stored
_ONE_PIECE = 1 << 20  # arrow's own block: its intermediate results stay in the cache
_NO_VALUE = ["", "nan", "NaN", "NAN", "-nan", "null", "NULL", "N/A", "n/a", "NA", "--"]


class Hasher:
    """SHA-256 of a file, taken in a thread of its own from the bytes that are parsed anyway."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()
        self._thread = ThreadPoolExecutor(1)

    def update(self, data: bytes | memoryview) -> Future[None]:
        """Add bytes; they may be overwritten when the future is done."""
        return self._thread.submit(self._digest.update, data)

    def hexdigest(self) -> str:
        """Return the sum of all that was added."""
        self._thread.shutdown(wait=True)
        return self._digest.hexdigest()


class _Work(NamedTuple):
    """A block in work: its buffer is used again when both are done."""

    buffer: bytearray
    parsed: Future[list[list[np.ndarray]]]
    hashed: Future[None] | None


def read_table(
    raw: RawText,
    table: Table,
    signals: list[ReadColumn],
    dialect: Dialect,
    hasher: Hasher | None = None,
    size: int = 0,
) -> tuple[dict[str, np.ndarray], int]:
    """Read the columns of one table, in SI.

    Parameters
    ----------
    raw, table
        The file and the table in it, from `tribolab.io.dialects.headers.find_tables`.
    signals
        The columns to read.
    dialect
        How the numbers are written.
    hasher
        Given every byte of the file in passing, those around the table too.
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
        If a cell is no number or a row has the wrong number of cells.
    """
    parser = _Parser(raw, table, signals, dialect)
    columns = _Columns(signals, table.stop - table.start, size)
    try:
        with _opened(raw) as file, ThreadPoolExecutor(_WORKERS) as workers:
            if hasher:
                hasher.update(file.read(table.start))
            _pump(file, table, parser, columns, workers, hasher)
            while hasher and (rest := file.read(BLOCK)):
                hasher.update(rest).result()
    except OSError as error:
        raise ReadError(f"{raw.file.path}: the file cannot be read any more: {error}") from error
    return columns.finished(), parser.incomplete


def _opened(raw: RawText) -> io.FileIO | io.BytesIO:
    return raw.file.path.open("rb", buffering=0) if raw.memory is None else io.BytesIO(raw.memory)


def _pump(
    file: io.FileIO | io.BytesIO,
    table: Table,
    parser: _Parser,
    columns: _Columns,
    workers: ThreadPoolExecutor,
    hasher: Hasher | None,
) -> None:
    """Pass a table on in blocks of whole lines, in a few buffers that are used in turn."""
    file.seek(table.start)
    place, left, rest = table.start, table.stop - table.start, b""
    block = min(BLOCK, left // _WORKERS + 1)  # a small table is shared between the workers too
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


class _Parser:
    """Turns blocks of lines into arrow tables, and arrow's complaints into ours."""

    def __init__(self, raw: RawText, table: Table, signals: list[ReadColumn], dialect: Dialect):
        self._raw, self._table, self._signals, self._dialect = raw, table, signals, dialect
        names = [str(index) for index in range(table.width)]
        self._wanted = [names[signal.place] for signal in signals]
        delimiter = dialect.text.delimiter
        dated = dialect.time.format is not None
        self._dates = {names[s.place] for s in signals if dated and s.quantity == "time"}
        self.incomplete = 0
        self._parse = {"delimiter": "\t" if delimiter == "whitespace" else delimiter}
        self._read = arrow_csv.ReadOptions(
            column_names=names, block_size=_ONE_PIECE, use_threads=False
        )
        self._convert: Arguments = {
            "include_columns": list(dict.fromkeys(self._wanted)),
            "null_values": ["", *dialect.text.missing],
            "decimal_point": dialect.text.table_decimal,
            "check_utf8": False,
        }

    def parse(self, view: memoryview, place: int, last: bool) -> list[list[np.ndarray]]:
        """Numbers of one block: for each signal its pieces, still in the file's unit."""
        types = {
            name: pa.string() if name in self._dates else pa.float64() for name in self._wanted
        }
        if not view:  # a line longer than a block: it goes on in the next
            return [[] for _ in self._wanted]
        try:
            table = self._arrow(view, types)
        except pa.ArrowInvalid as error:
            table = self._second_try(bytes(view), place, last, types, error)
        return [
            [self._numbers(name, piece) for piece in table[name].chunks] for name in self._wanted
        ]

    def _numbers(self, name: str, cells: pa.Array) -> np.ndarray:
        """Cells as numbers; dates and times as seconds."""
        if name not in self._dates:
            return cells.to_numpy(zero_copy_only=False)
        form = str(self._dialect.time.format)
        missing = {*_NO_VALUE, *self._convert["null_values"]}
        try:
            return seconds(cells.to_pandas(), form, missing)
        except ValueError as error:
            raise ReadError(
                f"'{shown(str(error), 40)}' is no date and time of the form '{shown(form)}'; see "
                f"[time] format in the dialect '{self._dialect.name}'",
                where=self._raw.file.path,
            ) from error

    def _arrow(self, block: bytes | memoryview, types: Arguments) -> pa.Table:
        held = block.obj if isinstance(block, memoryview) else block
        assert isinstance(held, bytes | bytearray)  # `_pump` passes views of its own buffers
        # arrow is faster where it need not look for quotes
        quote = '"' if held.find(b'"', 0, len(block)) >= 0 else False
        return arrow_csv.read_csv(
            pa.BufferReader(pa.py_buffer(block)),
            read_options=self._read,
            parse_options=arrow_csv.ParseOptions(**self._parse, quote_char=quote),
            convert_options=arrow_csv.ConvertOptions(**self._convert, column_types=types),
        )

    def _second_try(
        self, block: bytes, place: int, last: bool, types: Arguments, error: Exception
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
        raise ReadError(self._diagnosis(block, place)) from error

    def endless(self, place: int) -> ReadError:
        """Return the error for a line that does not end; it starts at an offset."""
        return ReadError(endless(self._lines_before(place) + 1), where=self._raw.file.path)

    def _cells(self, line: bytes) -> int:
        return line.count(self._parse["delimiter"].encode()) + 1

    def _diagnosis(self, block: bytes, place: int) -> str:
        """Name the first line of a block that cannot be read."""
        path = self._raw.file.path
        before = self._lines_before(place)
        lines = block.decode("utf-8", errors="replace").splitlines()
        delimiter, missing = self._parse["delimiter"], {*_NO_VALUE, *self._convert["null_values"]}
        is_table = place > self._table.start  # else what it holds is not told: it may be anything
        for number, line in enumerate(lines):
            if not line.strip():
                continue
            cells = [cell.strip().strip('"').strip() for cell in line.split(delimiter)]
            where = f"{path}: line {before + number + 1}"
            if len(cells) != self._table.width:
                told = f": '{shown(line, 60)}'" if is_table else ""
                return (
                    f"{where} has {len(cells)} cells where {self._table.width} are expected{told}; "
                    "if the table ends before it, say so in the dialect: [text] end = '...'"
                )
            for signal in self._signals:
                cell = cells[signal.place]
                if str(signal.place) in self._dates:
                    continue
                if cell not in missing and not _is_number(cell, self._dialect.text.table_decimal):
                    told = f"'{shown(cell, 40)}'" if is_table else "what stands there"
                    word = shown(cell, 40) if is_table else "..."
                    return (
                        f"{where}, column '{shown(signal.label)}': {told} is not a number; if it "
                        f"stands for a missing value, say so in the dialect: [text] missing = "
                        f"['{word}']"
                    )
            is_table = True
        return (
            f"{path}: the rows after line {before} cannot be read; is a quotation mark left open "
            "there?"
        )

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

    def __init__(self, signals: list[ReadColumn], size: int, of: int):
        self._signals, self._size = signals, size
        self._parts = max(1.0, of / max(size, 1))  # of the run, of this one's size
        self._arrays: list[np.ndarray] = []
        self._used = 0

    def take(self, pieces: list[list[np.ndarray]]) -> None:
        """Append one block's pieces."""
        rows = sum(len(piece) for piece in pieces[0])
        if rows == 0:
            return
        self._make_room(rows)
        for signal, array, chunks in zip(self._signals, self._arrays, pieces, strict=True):
            at = self._used
            for chunk in chunks:
                target = array[at : at + len(chunk)]
                with np.errstate(over="ignore"):  # a damaged number may be beyond all numbers
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
            # what is allocated but never touched takes no memory, so guess high
            guess = max(rows, min(rows * (self._size // BLOCK + 2), self._size // 2 + 1))
            self._arrays = [self._room(guess) for _ in self._signals]
        if self._used + rows > len(self._arrays[0]):
            for k, array in enumerate(self._arrays):
                self._arrays[k] = self._room(max(2 * len(array), self._used + rows))
                self._arrays[k][: self._used] = array[: self._used]
                let_go()

    def _room(self, rows: int) -> np.ndarray:
        """Return an array for that many rows: of a long run in a scratch file, else of arrow's.

        Numpy's asks for huge pages, and where memory is in many pieces the system first clears
        them.
        """
        of = int(rows * self._parts)
        return room(rows, of=of) if is_long(of) else np.frombuffer(pa.allocate_buffer(8 * rows))

    def finished(self) -> dict[str, np.ndarray]:
        """Arrays by quantity, cut to the rows that came."""
        arrays = self._arrays or [np.empty(0) for _ in self._signals]
        return {
            s.quantity: array[: self._used] for s, array in zip(self._signals, arrays, strict=True)
        }


def _scaled(numbers: np.ndarray, scale: float, out: np.ndarray) -> None:
    """Multiply so that 49.703 mm is 0.049703 m: dividing by 1000 rounds once, times 0.001 twice."""
    inverse = 1.0 / scale
    if abs(inverse) > 1.0 and abs(inverse - round(inverse)) < 1e-12 * abs(inverse):
        np.divide(numbers, float(round(inverse)), out=out)
    else:
        np.multiply(numbers, scale, out=out)
