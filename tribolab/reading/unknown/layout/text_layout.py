"""Layout of an unknown text file: encoding, line ends, delimiter, decimal mark, tables.

Only the first megabyte is inspected line by line, and the end of a longer file for a footer.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import NoNumbersError, ReadError, shown
from tribolab.reading.dialect.delimited.normalised_text import line_feeds
from tribolab.reading.numbers import escaped, numbers_in
from tribolab.reading.raw import limits
from tribolab.reading.text.cells import split_row
from tribolab.reading.text.first_bytes import HEAD, File
from tribolab.reading.text.number_spelling import (
    Mark,
    find_thousands,
    has_commas_in_quotes,
    is_unusual,
    usual,
    without_commas_in_quotes,
    without_thousands,
)
from tribolab.reading.unit_texts import is_unit
from tribolab.reading.unknown.layout.header import (
    STEP_WORD,
    Block,
    Heading,
    find_blocks,
    main_blocks,
)
from tribolab.reading.unknown.layout.lines import (
    DELIMITERS,
    Grammar,
    find_encoding,
    find_grammar,
    find_line_ends,
)
from tribolab.reading.unknown.layout.patterns import (
    end_pattern,
    header_pattern,
    last_lines,
    step_pattern,
)

_LAST_LINES = 20  # lines at the end that show the delimiter
_CELLS = 4  # delimiters per column, at most: blanks for alignment, decimal commas
_MAX_COLUMNS, _MIN_WIDE_ROWS = 1000, 5  # files without line ends seem to have few, wide rows
_MAX_ABOVE = 500  # lines of text above a table that are inspected
_MAX_LINE = 300  # characters of such a line that are searched


class Held(NamedTuple):
    """Location of the table in a file with named columns: the format, and the sheet of a workbook.

    `increment` is the sampling interval [s] if the file states it; `others` lists other tables
    with the same column names.
    """

    form: str
    sheet: str = ""
    line: int = 1
    units_below: bool = False
    increment: float = 0.0
    others: str = ""


class Layout(NamedTuple):
    """Layout of a file, and the lines of its main table (or of its repeated tables).

    If the file stores binary numbers, they are in `numbers` (rows, columns), and `lines` is only
    the text above them.
    """

    file: File
    delimiter: str
    width: int
    lines: tuple[str, ...]
    blocks: tuple[Block, ...]
    heading: Heading | None
    encoding: str = "utf-8"
    line_ends: str = "LF"
    decimal: str = "."
    others: int = 0
    header_line: int | None = None
    header_pattern: str | None = None
    skip: int = 0
    repeats: bool = False
    step: str | None = None
    end: str | None = None
    skipped: str | None = None
    whole: bool = True
    notes: tuple[str, ...] = ()
    guesses: tuple[str, ...] = ()
    held: Held | None = None
    thousands: Mark = ""
    quoted: bool = False
    foot: tuple[str, ...] = ()
    numbers: np.ndarray | None = None

    @property
    def delimiter_name(self) -> str:
        """The delimiter in words."""
        return DELIMITERS[self.delimiter]

    def text_above(self, *, bare: bool = False) -> tuple[str, ...]:
        """Return the first lines of the text above the table.

        If the file begins with its table, return the lines below the table.

        Parameters
        ----------
        bare
            Whether a table without a header may have text above it, as heights do. Without
            `bare`, such a table has none.
        """
        stop = self.blocks[0].start if bare and self.blocks else 0
        stop = self.heading.names if self.heading is not None else stop
        above = self.lines[: min(stop, _MAX_ABOVE)]
        nothing = self.heading is not None and not any(line.strip() for line in above)
        return self.foot[:_MAX_ABOVE] if nothing else above

    def sentences(self, *, bare: bool = False) -> list[str]:
        """Return the lines of `text_above`, without blanks around them and cut if very long."""
        return [line.strip()[:_MAX_LINE] for line in self.text_above(bare=bare)]

    @property
    def named_sentences(self) -> list[str]:
        """The lines of `sentences`, and the name of the file."""
        return [*self.sentences(), self.file.path.stem]

    @property
    def units_line(self) -> int:
        """Number of lines from the names to the units, without blank lines; 0 without units."""
        heading = self.heading
        if heading is None or heading.units is None:
            return 0
        rows = self.lines[heading.names + 1 : heading.units + 1]
        return sum(1 for line in rows if line.strip())

    @property
    def row_count(self) -> int:
        """Number of rows of numbers that were inspected."""
        return sum(len(block.rows) for block in self.blocks)

    def rows(self, most: int | None = None) -> list[str]:
        """Return the first rows of all blocks, with the cells in the order of the first block."""
        if self.numbers is not None:
            return ["\t".join(f"{x:.9g}" for x in row) for row in self.numbers[:most]]
        return [line for block in self.blocks for line in self._in_order(block)][:most]

    def _in_order(self, block: Block) -> list[str]:
        lines = [self.lines[index] for index in block.rows]
        if self.heading is None or block.heading is None:
            return lines
        if block.heading.cells == self.heading.cells:
            return lines
        left = list(enumerate(block.heading.cells))
        places = []
        for name in self.heading.cells:  # columns with equal names keep their order
            place = next(place for place, cell in left if cell == name)
            left.remove((place, name))
            places.append(place)
        rows = (split_row(line, self.delimiter) for line in lines)
        mark = " " if self.delimiter == "whitespace" else self.delimiter
        return [mark.join(row[p] if p < len(row) else "" for p in places) for row in rows]


def _refuse_wide(file: File, lines: Sequence[str]) -> None:
    """Raise if rows have far too many cells, before each row is inspected."""
    filled = [line for line in lines if line.strip()]
    widths = [max(len(line.split()), *map(line.count, "\t;,")) for line in filled]
    wide = [width for width in widths if width > _CELLS * limits.COLUMNS.value]
    if 2 * len(wide) > len(filled):
        raise ReadError(
            f"some {wide[0]} columns are more than a measurement has",
            where=file.path,
            cure="save those of the run in a file of their own; is each row on a line of its own?",
        )


def find_layout(file: File) -> Layout:
    """Return the layout of a text file.

    Raises
    ------
    ReadError
        If the file contains no table of numbers.
    """
    encoding, notes = find_encoding(file.head)
    guesses: list[str] = []
    raw = file.head if file.size <= HEAD else file.head[: file.head.rfind(b"\n") + 1]
    text = raw.decode(encoding, errors="replace").removeprefix("\ufeff")
    text = usual(text) if is_unusual(text) else text
    quoted = has_commas_in_quotes(text)
    text = without_commas_in_quotes(text) if quoted else text
    lines = tuple(line_feeds(text).split("\n"))
    if thousands := find_thousands(lines):
        apart = any("\t" in line or ";" in line for line in lines[-_LAST_LINES:])
        lines = tuple(without_thousands(x, thousands, ";" if apart else ",") for x in lines)
    _refuse_wide(file, lines)
    grammar = find_grammar(lines)
    if grammar is None:
        raise NoNumbersError(
            "no table of numbers was found in the file",
            where=file.path,
            cure="exclude it if it is not a measurement; otherwise write a Python reader "
            "(raw_data_schema/README.md)",
        )
    blocks = find_blocks(lines, grammar)
    main, others = main_blocks(blocks)
    main, skipped = _with_rows_after_events(lines, blocks, main, grammar)
    first = main[0]
    guesses += _rows_that_may_belong(lines, blocks, main, grammar)
    rows = sum(len(block.rows) for block in main)
    if first.width > limits.COLUMNS.value or (first.width > _MAX_COLUMNS and rows < _MIN_WIDE_ROWS):
        raise ReadError(
            f"{file.path}: {first.width} columns in {rows} rows are more than an instrument "
            "writes; is it the right file, and is each row on a line of its own?"
        )
    heading = first.heading
    pattern, repeats = header_pattern(lines, main, grammar) if heading else (None, False)
    if heading and pattern is None and len(main) > 1:
        main, others = main[:1], others + len(main) - 1
        guesses.append("only the first of several tables is read: their headers are not unique")
    tail = last_lines(file, encoding)
    end = end_pattern(lines, main, tail, grammar)
    if tail and pattern is not None and end is not None:
        repeats = True  # so that the reader searches the whole file for the end of the table
    if heading:
        below = (heading.names if heading.units is None else heading.units) + 1
        skip = sum(1 for index in range(below, first.start) if lines[index].strip())
        skip = 0 if skip == 0 else first.start - below
    else:
        skip = first.start
    return Layout(
        file=file,
        encoding=encoding,
        line_ends=find_line_ends(raw),
        delimiter=grammar.delimiter,
        decimal=grammar.decimal,
        width=first.width,
        lines=lines,
        blocks=tuple(main),
        others=others,
        heading=heading,
        header_line=heading.names + 1 if heading and pattern is None else None,
        header_pattern=pattern,
        skip=skip,
        repeats=repeats,
        step=step_pattern(lines, main) if repeats else None,
        end=end,
        skipped=skipped,
        whole=file.size <= HEAD,
        notes=tuple(notes),
        guesses=tuple(guesses),
        thousands=thousands,
        quoted=quoted,
        foot=_foot(lines, main, tail, grammar) if end is not None and len(main) == 1 else (),
    )


def _with_rows_after_events(
    lines: Sequence[str], blocks: Sequence[Block], main: list[Block], grammar: Grammar
) -> tuple[list[Block], str | None]:
    """Join the rows between lines of events to one table, and return a pattern for these lines.

    This is done only if the first numbers of all rows increase like a clock, and if no event
    states an amount or begins a step, which may change the meaning of the rows. File: Phoenix TE 77
    (Compend 2000), "Fast data in ..." between rows.
    """
    if len(main) != 1:
        return main, None
    place = next(n for n, block in enumerate(blocks) if block == main[0])
    rows, events = list(main[0].rows), []
    for block in blocks[place + 1 :]:
        between = [x.strip() for x in lines[rows[-1] + 1 : block.start] if x.strip()]
        if block.heading is not None or block.width != main[0].width or not between:
            break
        if any(not x[0].isalpha() or _SETS.search(x) or _amounts(x) for x in between):
            break
        rows += block.rows
        events += between
    clock = [_first_number(lines[index], grammar) for index in rows] if events else []
    if not events or not (np.diff(clock) > 0).all():
        return main, None
    words = sorted({_AFTER_WORDS.split(event, maxsplit=1)[0] for event in events})
    pattern = f"^(?:{'|'.join(map(escaped, words))})"
    return [main[0]._replace(stop=rows[-1] + 1, rows=tuple(rows))], pattern


_SETS = re.compile(rf"{STEP_WORD}\D{{0,5}}\d", re.IGNORECASE)
_AFTER_WORDS = re.compile(r"[\d=:]")


def _amounts(line: str) -> bool:
    return any(is_unit(number.unit) for number in numbers_in(line[:200]) if number.unit)


def _first_number(line: str, grammar: Grammar) -> float:
    cells = (c for c in grammar.cells(line) if grammar.is_number(c))
    return float(next(cells, "nan").replace(grammar.decimal, "."))


def _rows_that_may_belong(
    lines: Sequence[str], blocks: Sequence[Block], main: Sequence[Block], grammar: Grammar
) -> list[str]:
    """Return a guess if rows below a line of text are not read, but may belong to the table."""
    chosen = next(n for n, block in enumerate(blocks) if block.stop >= main[-1].stop)
    later = blocks[chosen + 1 :]
    alike = (b for b in later if b.heading is None and b.width == main[-1].width)
    rows = sum(len(b.rows) for b in alike if not grammar.is_footer(lines[b.start]))
    mark = next((line.strip() for line in lines[main[-1].stop :] if line.strip()), "")
    said = f"the table ends at '{shown(mark, 40)}': {rows} rows below it are not read"
    return [said] if rows else []


def _foot(
    lines: Sequence[str], main: Sequence[Block], tail: Sequence[str], grammar: Grammar
) -> tuple[str, ...]:
    """Return the lines of text below the table."""
    if not tail:
        return tuple(lines[main[-1].stop :])
    last = max((n for n, row in enumerate(tail, 1) if grammar.width(row)), default=len(tail))
    return tuple(tail[last:])
