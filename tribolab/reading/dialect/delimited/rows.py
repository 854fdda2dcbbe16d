"""Parsing of blocks of lines into numbers, and diagnosis of invalid lines."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from tribolab.core.errors import ReadError, shown
from tribolab.core.untyped import Arguments
from tribolab.reading.dialect.columns import ReadColumn
from tribolab.reading.dialect.delimited.headers import endless
from tribolab.reading.dialect.delimited.tables import RawText, TextTable
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.dates import seconds

_ONE_PIECE = 1 << 20  # arrow's default block, whose intermediate results fit in the cache
_BLANK = ["", " ", "  ", "   "]  # arrow does not strip blanks
_NO_VALUE = ["", "nan", "NaN", "NAN", "-nan", "null", "NULL", "N/A", "n/a", "NA", "--"]


class RowParser:
    """Parser of blocks of lines into arrow tables, with readable errors."""

    def __init__(self, raw: RawText, table: TextTable, signals: list[ReadColumn], dialect: Dialect):
        self._raw, self._table, self._signals, self._dialect = raw, table, signals, dialect
        names = [str(index) for index in range(table.width)]
        self._wanted = [names[signal.place] for signal in signals]
        delimiter = dialect.text.delimiter
        dated = dialect.time.format is not None
        self._dates = {names[s.place] for s in signals if dated and s.quantity == "time"}
        self.incomplete = 0
        self._parse: Arguments = {
            "delimiter": "\t" if delimiter == "whitespace" else delimiter,
            # in a single column, empty lines are missing values
            "ignore_empty_lines": table.width > 1,
        }
        self._read = arrow_csv.ReadOptions(
            column_names=names, block_size=_ONE_PIECE, use_threads=False
        )
        self._convert: Arguments = {
            "include_columns": list(dict.fromkeys(self._wanted)),
            "null_values": [*_BLANK, *dialect.text.missing],
            "decimal_point": dialect.text.table_decimal,
            "check_utf8": False,
        }

    def parse(self, view: memoryview, place: int, last: bool) -> list[list[np.ndarray]]:
        """Return the numbers in a block of lines, in the file's units: arrays for each signal."""
        types = {
            name: pa.string() if name in self._dates else pa.float64() for name in self._wanted
        }
        if not view:  # the block has no line end: its line continues in the next block
            return [[] for _ in self._wanted]
        try:
            table = self._arrow(view, types)
        except pa.ArrowInvalid as error:
            table = self._parse_incomplete(bytes(view), place, last, types, error)
        return [
            [self._numbers(name, piece) for piece in table[name].chunks] for name in self._wanted
        ]

    def _numbers(self, name: str, cells: pa.Array) -> np.ndarray:
        """Return cells as numbers; dates and times as seconds."""
        if name not in self._dates:
            return floats_of(cells)
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
        assert isinstance(held, bytes | bytearray)  # callers pass views of whole buffers
        # arrow is faster without quotes
        quote = '"' if held.find(b'"', 0, len(block)) >= 0 else False
        return arrow_csv.read_csv(
            pa.BufferReader(pa.py_buffer(block)),
            read_options=self._read,
            parse_options=arrow_csv.ParseOptions(**self._parse, quote_char=quote),
            convert_options=arrow_csv.ConvertOptions(**self._convert, column_types=types),
        )

    def _parse_incomplete(
        self, block: bytes, place: int, last: bool, types: Arguments, error: Exception
    ) -> pa.Table:
        """Parse again without an incomplete last row; else raise with a diagnosis.

        Superfluous delimiters at the end of rows, e.g. next to a comment, are removed.
        """
        if (tidy := self._without_surplus(block)) != block:
            try:
                return self._arrow(tidy, types)
            except pa.ArrowInvalid:
                block = tidy
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

    def _without_surplus(self, block: bytes) -> bytes:
        mark = self._parse["delimiter"].encode()
        most = self._table.width - 1
        lines = block.split(b"\n")
        for number, line in enumerate(lines):
            surplus = line.count(mark) - most
            bare = line.rstrip(mark + b" \r")
            if surplus > 0 and bare.count(mark) <= most:
                lines[number] = bare + mark * (most - bare.count(mark))
        return b"\n".join(lines)

    def endless(self, place: int) -> ReadError:
        """Return the error for an endless line that starts at an offset."""
        return ReadError(endless(self._lines_before(place) + 1), where=self._raw.file.path)

    def _cells(self, line: bytes) -> int:
        return line.count(self._parse["delimiter"].encode()) + 1

    def _diagnosis(self, block: bytes, place: int) -> str:
        """Return a message on the first invalid line of a block."""
        path = self._raw.file.path
        before = self._lines_before(place)
        lines = block.decode("utf-8", errors="replace").splitlines()
        delimiter, missing = self._parse["delimiter"], {*_NO_VALUE, *self._convert["null_values"]}
        is_table = place > self._table.start  # messages quote only cells of a table
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
                    told = f"'{shown(cell, 40)}'" if is_table else "the text there"
                    word = shown(cell, 40) if is_table else "..."
                    return (
                        f"{where}, column '{shown(signal.label)}': {told} is not a number; if it "
                        f"marks a missing value, state it in the dialect: [text] missing = "
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
                file.read(min(_ONE_PIECE, place - start)).count(b"\n")
                for start in range(0, place, _ONE_PIECE)
            )


def _is_number(cell: str, decimal: str) -> bool:
    if decimal == "," and "." in cell:
        return False
    try:
        float(cell.replace(decimal, "."))
    except ValueError:
        return False
    return True


def floats_of(cells: pa.Array) -> np.ndarray:
    """Return an arrow array of float64 as numpy array, with NaN for missing values.

    Arrow's conversion loads pandas, which takes longer than reading a file of 5 MB.

    >>> floats_of(pa.array([0.5, None, 2.5])[1:]).tolist()
    [nan, 2.5]
    """
    if not len(cells):
        return np.empty(0)
    known, numbers = cells.buffers()
    rows = slice(cells.offset, cells.offset + len(cells))
    values = np.frombuffer(numbers, dtype=float)[rows]
    if not cells.null_count:
        return values
    bits = np.unpackbits(np.frombuffer(known, dtype=np.uint8), bitorder="little")[rows]
    return np.where(bits.astype(bool), values, np.nan)
