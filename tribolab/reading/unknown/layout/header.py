"""Tables of numbers in a text: their rows, their headers, and the choice of the main table."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from tribolab.reading.dialect.delimited.headers import counts_its_rows
from tribolab.reading.lexicon.lexicon import alternatives, known_words
from tribolab.reading.unit_texts import is_unit
from tribolab.reading.unknown.layout.lines import Grammar
from tribolab.units.spellings import MICRO

if TYPE_CHECKING:
    from tribolab.reading.unknown.layout.lines import Grammar

_ABOVE = 8  # lines above the first row that may be its header
_MAX_MARK = 80  # characters of a line that separates header and numbers
_TELLING = 200  # cells that are searched for units or known names
_WORD = re.compile(r"\S+")
# A name of several words with its unit in brackets, or a single word. The length is limited: a long
# line without brackets would otherwise be searched once for each of its words.
_BRACKETED = re.compile(r"\S[^\[\]()]{0,200}?[\[(][^\[\]()]{0,100}[\])]|\S+")
# "Units,um" and "Points,1500" are settings, not column names
_SETTING = re.compile(
    rf"[^\W\d]\W*[,;]\W*(?:{alternatives('unit_alone')}|[-+]?\d[\d.,]*)\W*$"
    rf"|^\W*{alternatives('unit_key')}\s+[^\W\d]{{1,3}}\W*$"
    rf"|(?<![\w.,(\[])\d+(?:[.,]\d+|[.,]?\d*\s?(?:[nmku{MICRO}]?m|Å|Hz|N|s|mm/s|°C)(?![^\W\d_]))"
    r"(?![^()\[\]]*[)\]])",
    re.IGNORECASE,
)
# lines that separate the header from the numbers: "End of header"
_MARK = re.compile(
    rf"\W*(?:{alternatives('ends')}(?=[\W_]|$)[\s_\-]*(?:of|der|des|de[lr]?|du|dell[ao']|da|do|van)?"
    r"[\s_\-]*(?:the|la|l')?[\s_\-]*(?:file|datei)?[\s_\-]*"
    rf"{alternatives('header_or_data')}?"
    r"|(?:header|data|header[\s_\-]*section)[\s_\-]*(?:end|start|begin)s?"
    rf"|{alternatives('header_ends_unparted')})\W*",
    re.IGNORECASE,
)
_LIST = re.compile(
    r"[#%]\W*(?:(?P<units>units)|columns|column names|fields)\s*[:=]\s*(?P<list>\S.*)",
    re.IGNORECASE,
)
_STEMS = frozenset(stem for word in known_words("run") for stem in (*word.stems, *word.vague))
_SYMBOLS = frozenset(symbol for word in known_words("run") for symbol in word.symbols)


# words for a step of a test programme
STEP_WORD = alternatives("step")


class Heading(NamedTuple):
    """A header: line indices and cells of the names and of the row of units.

    `aligned` is False if the delimiter of the numbers does not separate the names; columns are then
    identified by their position.
    """

    names: int
    units: int | None
    cells: tuple[str, ...]
    unit_cells: tuple[str, ...]
    aligned: bool


class Block(NamedTuple):
    """Consecutive lines of numbers, with their header; line indices count from 0."""

    start: int
    stop: int
    rows: tuple[int, ...]
    width: int
    heading: Heading | None


def find_heading(lines: Sequence[str], start: int, grammar: Grammar, width: int) -> Heading | None:
    """Return the header of the table whose first row is line `start` (from 0), or None."""
    above: list[int] = []
    for index in range(start - 1, max(start - _ABOVE, 0) - 1, -1):
        if numbers := grammar.width(lines[index]):
            if index == start - 1 and numbers == width - 1 > 1:
                continue  # the first row lacks its last cell, and is left out
            break
        text = lines[index][:_MAX_MARK]
        if width == 1 and (_MARK.fullmatch(text) or _SETTING.search(text)):
            break  # the name of a single column is directly above its numbers
        if lines[index].strip():
            above.append(index)
    if (listed := _listed(lines, above, width)) is not None:
        return listed
    counted = counts_its_rows(lines[start : start + 2], grammar.delimiter)
    split = {index: _cells(lines[index], grammar, width, counted) for index in above[:3]}
    fitting = {
        i: c
        for i, c in split.items()
        if _fits(lines[i], c[0], grammar, width) or _is_row_of_units(c[0], grammar, width)
    }
    for index, (cells, aligned) in fitting.items():
        over = [above for above in fitting if above < index]
        if _are_units(cells) and over:
            # numbers of channels or a row of delimiters may separate names and units
            best = max(over, key=lambda above: (_known(fitting[above][0]), above))
            names, named = fitting[best]
            return Heading(best, index, names, cells, aligned and named)
    if not fitting:
        return None
    index, (cells, aligned) = next(iter(fitting.items()))
    return Heading(index, None, cells, (), aligned)


def _listed(lines: Sequence[str], above: Sequence[int], width: int) -> Heading | None:
    """Return the header if comment lines list the column names, and perhaps units; else None.

    File: JPK NanoWizard, "# columns: height vDeflection", "# units: m N"
    (stemarcotti/AFM-data-plot).
    """
    found: dict[str, tuple[int, tuple[str, ...]]] = {}
    for index in above:
        match = _LIST.fullmatch(lines[index].strip()) if width > 1 else None
        cells = tuple(match["list"].replace(",", " ").split()) if match else ()
        if match and len(cells) == width:
            found["units" if match["units"] else "names"] = index, cells
    if "names" not in found:
        return None
    names, cells = found["names"]
    units, unit_cells = found.get("units", (None, ()))
    return Heading(names, units, cells, unit_cells, False)


def first_cells(line: str, delimiter: str) -> str:
    """Return the first two cells of a line as written, or the whole line for blanks."""
    if delimiter == "whitespace":
        return line.strip()
    cells = line.split(delimiter)
    return delimiter.join(cells[:2]) + (delimiter if len(cells) > 2 else "")


def _cells(line: str, grammar: Grammar, width: int, counted: bool) -> tuple[tuple[str, ...], bool]:
    """Return the cells of a header, and whether the delimiter of the numbers separates them.

    With `counted`, rows begin with a row number, for which the header may have no name.
    """
    cells = tuple(grammar.cells(line))
    if counted and len(cells) == width - 1 and not any(map(grammar.is_number, cells)):
        return ("", *cells), True
    if grammar.delimiter != "whitespace" or len(cells) == width:
        return cells, True
    bare = line.strip().lstrip("#%/*;!\"' ").strip()
    for parts in (bare.split(), re.split(r"\t+|\s{2,}", bare), _BRACKETED.findall(bare)):
        if len(parts) == width:
            return tuple(part.strip().strip('"') for part in parts), False
    return cells, False


def _fits(line: str, cells: Sequence[str], grammar: Grammar, width: int) -> bool:
    """Whether a line can be the header of a table of a given width."""
    filled = [cell for cell in cells if cell]
    words = [cell for cell in filled if not grammar.is_number(cell)]
    if not filled or len(words) < 0.7 * len(filled) or _MARK.fullmatch(line[:_MAX_MARK]):
        return False
    if re.match(r"\s*(#|%|//|;|\*|!)", line) and re.search(r"[:=]", line):
        return False  # a comment that is a setting: "# rate: 10 Hz"
    # a cell such as "Operator:" is a setting; "Interval data:" may precede all column names
    first = 1 if len(cells) == width and len(filled) > 3 else 0
    if any(cell.endswith((":", "=")) for cell in filled[first:]) or not re.search(r"\w", line):
        return False
    if grammar.delimiter == "whitespace" and len(cells) != width:
        return False
    if width == 1:
        return len(filled) == 1 and len(line) < 60 and not re.search(r"[:=]\s*\S", line)
    return len(filled) >= 2 and 0.5 * width <= len(cells) <= 1.5 * width + 2


def _is_row_of_units(cells: Sequence[str], grammar: Grammar, width: int) -> bool:
    """Whether a row contains only units, perhaps for a few columns only: ";N"."""
    if grammar.delimiter == "whitespace" or len(cells) != width:
        return False
    return any(cells) and all(is_unit(cell.strip("[]() ")) for cell in cells if cell)


def names_any(cell: str, *quantities: str) -> bool:
    """Whether the name of a column may mean any of the given quantities.

    >>> names_any("FUERZA", "friction_force"), names_any("z [um]", "friction_force", "time")
    (True, False)
    """
    name = unicodedata.normalize("NFD", re.split(r"[\[(]", cell)[0].lower())
    text = "".join(filter(str.isalnum, name))  # without accents
    bare = text.rstrip("0123456789")  # without the number of a table or a sensor
    return any(
        bare in word.symbols or any(stem in text for stem in (*word.stems, *word.vague))
        for word in known_words("run")
        if word.quantity in quantities
    )


def _known(cells: Sequence[str]) -> int:
    """Return the number of cells with a known word or symbol."""
    texts = ["".join(filter(str.isalnum, cell.lower())) for cell in cells[:_TELLING]]
    return sum(text in _SYMBOLS or any(stem in text for stem in _STEMS) for text in texts)


def _are_units(cells: Sequence[str]) -> bool:
    filled = [cell.strip("[]() ") for cell in cells if cell][:_TELLING]
    units = sum(1 for cell in filled if is_unit(cell) or is_unit(cell.lower()) or cell == "-")
    return units >= 0.6 * len(filled)


def find_blocks(lines: tuple[str, ...], grammar: Grammar) -> list[Block]:
    """Return the blocks of rows with the same number of cells; they may contain blank lines."""
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
        if rows and grammar.plain_width(line) == width:
            rows.append(index)
            continue
        cells = grammar.width(line)
        if cells and rows and grammar.is_footer(line) and not grammar.is_footer(lines[rows[0]]):
            cells = 0
        if not cells and rows and grammar.goes_on(line, width):
            cells = width
        if rows and cells > width and grammar.filled(line) <= width:
            cells = width  # surplus delimiters at the end of the line
        elif len(rows) == 1 and 0 < cells < width and grammar.filled(lines[rows[0]]) <= cells:
            width = cells  # the first row had surplus delimiters
        if cells != width and not (rows and index == last and 0 < cells < width):
            close()
            width = cells
        if cells == width and cells:
            rows.append(index)
    close()
    return blocks


def main_blocks(blocks: list[Block]) -> tuple[list[Block], int]:
    """Return the blocks of the header that covers the most data, and how many other blocks exist.

    Blocks without a header count only if no block of the same width has a header.
    """
    weight: Counter[tuple[tuple[str, ...] | None, int]] = Counter()
    headed = {block.width for block in blocks if block.heading is not None}
    for block in blocks:
        if block.heading is not None or block.width not in headed:
            weight[_key(block)] += len(block.rows) * block.width
    key = weight.most_common(1)[0][0]
    main = [block for block in blocks if _key(block) == key]
    if key[0] is None:  # without a header, it is unknown which tables belong together
        main = [max(main, key=lambda block: len(block.rows))]
    return main, len(blocks) - len(main)


def _key(block: Block) -> tuple[tuple[str, ...] | None, int]:
    heading = block.heading
    if heading is None:
        return None, block.width
    # the order of columns may change from step to step if they have names
    cells = tuple(sorted(heading.cells)) if heading.aligned else heading.cells
    return cells, block.width
