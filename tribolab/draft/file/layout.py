"""How an unknown text file is written: encoding, line ends, delimiter, decimal mark, tables.

Only the first megabyte is looked at line by line, and the end of a longer file for a footer.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.file.header import Heading, escaped, find_heading, first_cells
from tribolab.draft.file.lines import (
    DELIMITERS,
    Grammar,
    find_encoding,
    find_grammar,
    find_line_ends,
)
from tribolab.draft.file.marks import Block, without_marks
from tribolab.errors import ReadError
from tribolab.io.dialects.headers import line_feeds, split_row
from tribolab.io.dialects.signature import HEAD, File
from tribolab.io.dialects.spelling import (
    has_commas_in_quotes,
    is_unusual,
    usual,
    without_commas_in_quotes,
)
from tribolab.io.dialects.thousands import Mark, find_thousands, without_thousands

_TAIL = 1 << 14
_FEW = 20  # lines at the end that tell what parts cells
_TRIED = 20  # patterns of a step's number
_MOST_COLUMNS = 20_000


class Held(NamedTuple):
    """Where columns are in a file that names them: its format, and of a workbook the sheet."""

    form: str
    sheet: str = ""
    line: int = 1
    units_below: bool = False


class Layout(NamedTuple):
    """How a file is written, and the lines of its main table (or of its repeated tables)."""

    file: File
    encoding: str
    line_ends: str
    delimiter: str
    decimal: str
    width: int
    lines: tuple[str, ...]
    blocks: tuple[Block, ...]
    others: int
    heading: Heading | None
    header_line: int | None
    header_pattern: str | None
    skip: int
    repeats: bool
    step: str | None
    end: str | None
    skip_lines: str | None
    whole: bool
    notes: tuple[str, ...]
    guesses: tuple[str, ...]
    held: Held | None = None
    thousands: Mark = ""
    quoted: bool = False

    @property
    def delimiter_name(self) -> str:
        """The delimiter in a word."""
        return DELIMITERS[self.delimiter]

    @property
    def units_line(self) -> int:
        """In which line below the names the units stand; a row of delimiters does not count."""
        heading = self.heading
        if heading is None or heading.units is None:
            return 0
        rows = self.lines[heading.names + 1 : heading.units + 1]
        return sum(1 for line in rows if line.strip())

    def rows(self) -> list[str]:
        """Lines of numbers of all blocks, their cells in the order of the first."""
        return [line for block in self.blocks for line in self._in_order(block)]

    def _in_order(self, block: Block) -> list[str]:
        lines = [self.lines[index] for index in block.rows]
        if self.heading is None or block.heading is None:
            return lines
        if block.heading.cells == self.heading.cells:
            return lines
        left = list(enumerate(block.heading.cells))
        places = []
        for name in self.heading.cells:  # of a name used twice, the first stays the first
            place = next(place for place, cell in left if cell == name)
            left.remove((place, name))
            places.append(place)
        rows = (split_row(line, self.delimiter) for line in lines)
        mark = " " if self.delimiter == "whitespace" else self.delimiter
        return [mark.join(row[p] if p < len(row) else "" for p in places) for row in rows]


def find_layout(file: File) -> Layout:
    """Find out how a text file is written.

    Parameters
    ----------
    file
        The file, looked at by `tribolab.io.dialects.signature.peek`.

    Raises
    ------
    ReadError
        If it holds no table of numbers.
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
        apart = any("\t" in line or ";" in line for line in lines[-_FEW:])
        lines = tuple(without_thousands(x, thousands, ";" if apart else ",") for x in lines)
    grammar = find_grammar(lines)
    if grammar is None:
        raise ReadError(
            f"{file.path}: no table of numbers stands in the file; a dialect describes text with "
            "at least one row of numbers"
        )
    blocks, skip_lines = without_marks(lines, _blocks(lines, grammar), grammar)
    main, others = _main(blocks)
    first = main[0]
    if first.width > _MOST_COLUMNS:
        raise ReadError(
            f"{file.path}: {first.width} columns are more than an instrument writes "
            f"({_MOST_COLUMNS}); is it the right file, and is each row on a line of its own?"
        )
    heading = first.heading
    pattern, repeats = _pattern(lines, main, grammar) if heading else (None, False)
    if heading and pattern is None and len(main) > 1:
        main, others = main[:1], others + len(main) - 1
        guesses.append("only the first of several tables is read: their headers are not unique")
    tail = _tail(file, encoding)
    end = _end(lines, main, tail, grammar)
    if tail and pattern is not None and end is not None:
        repeats = True  # only then is the whole file searched for the end of the table
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
        step=_step(lines, main) if repeats else None,
        end=end,
        skip_lines=skip_lines,
        whole=file.size <= HEAD,
        notes=tuple(notes),
        guesses=tuple(guesses),
        thousands=thousands,
        quoted=quoted,
    )


def _blocks(lines: tuple[str, ...], grammar: Grammar) -> list[Block]:
    """Rows of numbers of equal width that only blank lines part."""
    blocks: list[Block] = []
    rows: list[int] = []
    width = 0

    def close() -> None:
        if rows:
            heading = find_heading(lines, rows[0], grammar, width)
            blocks.append(Block(rows[0], rows[-1] + 1, tuple(rows), width, heading))
            rows.clear()

    last = max((index for index, line in enumerate(lines) if line.strip()), default=0)
    for index, line in enumerate(lines):
        if not line.strip():
            continue
        cells = grammar.width(line)
        if cells and rows and grammar.is_footer(line) and not grammar.is_footer(lines[rows[0]]):
            cells = 0
        if not cells and rows and grammar.goes_on(line, width):
            cells = width
        if cells != width and not (rows and index == last and 0 < cells < width):
            close()
            width = cells
        if cells == width and cells:
            rows.append(index)
    close()
    return blocks


def _main(blocks: list[Block]) -> tuple[list[Block], int]:
    """Return the blocks under the same header that hold most numbers; how many others there are."""
    weight: Counter[tuple[tuple[str, ...] | None, int]] = Counter()
    for block in blocks:
        weight[_key(block)] += len(block.rows) * block.width
    key = weight.most_common(1)[0][0]
    main = [block for block in blocks if _key(block) == key]
    if key[0] is None:  # without a header nothing joins several tables
        main = [max(main, key=lambda block: len(block.rows))]
    return main, len(blocks) - len(main)


def _key(block: Block) -> tuple[tuple[str, ...] | None, int]:
    heading = block.heading
    if heading is None:
        return None, block.width
    # the order of columns may change from step to step, where names tell which is which
    cells = tuple(sorted(heading.cells)) if heading.aligned else heading.cells
    return cells, block.width


def _pattern(
    lines: tuple[str, ...], blocks: list[Block], grammar: Grammar
) -> tuple[str | None, bool]:
    """Return a pattern that finds the headers and nothing else; whether there are several."""
    wanted = [block.heading.names for block in blocks if block.heading]
    headers = list(dict.fromkeys(lines[index] for index in wanted))
    repeats = len(wanted) > 1
    if wanted == [0]:
        return None, False
    for short in (True, False):
        texts = [
            escaped(first_cells(line, grammar.delimiter) if short else line.strip() or line)
            for line in headers
        ]
        texts = list(dict.fromkeys(texts))
        pattern = "^" + (texts[0] if len(texts) == 1 else f"(?:{'|'.join(texts)})")
        matched = [i for i, line in enumerate(lines) if re.match(pattern, line)]
        if matched == wanted or (not repeats and matched[:1] == wanted):
            return pattern, repeats
    return None, False


def _step(lines: tuple[str, ...], blocks: list[Block]) -> str | None:
    """Return a pattern for the steps' numbers, if they stand in the text before each header."""
    texts, done = [], 0
    for block in blocks:
        texts.append(lines[done : block.heading.names if block.heading else block.start])
        done = block.stop
    tried: set[str] = set()
    for line in texts[0]:
        told = re.match(
            r"(?i)(\W*(?:[a-z]+ ?- ?|(?:step|schritt|segment|stage)\D{0,5}))(\d+)\b", line
        )
        told = told or re.match(r"(.* - )(\d+)$", line)
        if not told:
            continue
        general = r"^.* - (\d+)$" if told[1].endswith(" - ") else f"^{escaped(told[1])}(\\d+)"
        if general in tried:
            continue
        tried.add(general)
        if len(tried) > _TRIED:
            break
        hits = [re.findall(general, "\n".join(text), re.MULTILINE) for text in texts]
        if not all(hits):
            continue
        numbers = [int(hit[-1]) for hit in hits]
        if all(b > a for a, b in zip(numbers, numbers[1:], strict=False)):
            return general
    return None


def _tail(file: File, encoding: str) -> list[str]:
    """Last lines of a file longer than what is looked at."""
    if file.size <= HEAD:
        return []
    with file.path.open("rb") as handle:
        handle.seek(max(file.size - _TAIL, HEAD))
        text = handle.read().decode(encoding, errors="replace")
    return line_feeds(text).split("\n")[1:]


def _end(
    lines: tuple[str, ...], blocks: list[Block], tail: list[str], grammar: Grammar
) -> str | None:
    """Return a pattern for the line that ends the table, if anything stands below it."""
    stops: list[tuple[Sequence[str], int]] = [(lines, block.stop) for block in blocks]
    if tail:
        stops[-1] = (
            tail,
            max((n for n, row in enumerate(tail, 1) if grammar.width(row)), default=0),
        )
    below, blank = [], True
    for text, stop in stops:
        after = next((n for n in range(stop, len(text)) if text[n].strip()), None)
        if after is not None:
            below.append(text[after])
            blank = blank and after > stop
    if not below:
        return None
    dense = all(block.stop - block.start == len(block.rows) for block in blocks)
    if blank and dense:
        return r"^\s*$"
    starts = {line.lstrip()[:1] for line in below}
    if all(start.isascii() and start.isalpha() for start in starts):
        starts = {"A-Za-z"}
    rows = {lines[index].lstrip()[:1] for block in blocks for index in block.rows}
    if "A-Za-z" in starts and not any(row.isalpha() for row in rows):
        return "^[A-Za-z]"
    if not starts & rows:
        return "^[" + "".join(re.escape(start) for start in sorted(starts)) + "]"
    return "^" + escaped(below[0].strip()[:20])
