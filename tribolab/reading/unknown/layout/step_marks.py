"""Lines of text between rows of one table, like "Step 2" or "# pause": the table goes on below."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import alternatives
from tribolab.reading.unknown.layout.header import Heading
from tribolab.reading.unknown.layout.lines import Grammar

# what steps of a programme are called
STEP_WORD = alternatives("step")
_ENDED = r"(?:end(?:e|ed|s)?|begin\w*|start\w*|finished|done|fin|fine|结束|開始|开始|終了|完成)"
_TITLE = re.compile(
    rf"\W*(?:(?:{_ENDED}\W{{1,3}}(?:of\W|der\W|de\W)?)?{STEP_WORD}\W{{0,4}}(?P<number>\d+)"
    rf"|第\s?(?P<nth>\d+)\s?(?:步|段|级|阶段|ステップ|工程))\W*{_ENDED}?\W*",
    re.IGNORECASE,
)
_LONG_TITLE = re.compile(
    rf"\W*{STEP_WORD}\W{{0,4}}(?P<number>\d{{1,4}})(?:\s?(?:/|of|von|de|di|sur)\s?\d+)?(?P<rest>\D.*|$)",
    re.IGNORECASE,
)
_FEW = 5  # rows below a mark that are more than a line of results
_SHARE = 0.01  # of the longest part


class Block(NamedTuple):
    """Lines of numbers that follow one another; indices of lines count from 0."""

    start: int
    stop: int
    rows: tuple[int, ...]
    width: int
    heading: Heading | None


def without_marks(
    lines: Sequence[str], blocks: list[Block], grammar: Grammar
) -> tuple[list[Block], str | None]:
    """Join blocks of numbers that only lines of text part, and no header.

    Parameters
    ----------
    lines
        Lines of the file.
    blocks
        Its blocks of numbers.
    grammar
        How cells are parted.

    Returns
    -------
    tuple
        The blocks, and the pattern of the lines to pass over; the blocks as they were and None
        where a line of text may as well begin something else.
    """
    runs: list[list[Block]] = []
    for block in blocks:
        if runs and block.heading is None and block.width == runs[-1][0].width:
            runs[-1].append(block)
        else:
            runs.append([block])
    parts = max(runs, key=lambda run: sum(len(block.rows) for block in run))
    if len(parts) < 2 or not _goes_on(lines, parts, grammar):
        return blocks, None
    rows = [row for block in parts for row in block.rows]
    between = [
        lines[index]
        for earlier, later in zip(parts, parts[1:], strict=False)
        for index in range(earlier.stop, later.start)
        if lines[index].strip()
    ]
    pattern = _pattern(between, [lines[row] for row in rows])
    if pattern is None:
        return blocks, None
    first, last = parts[0], parts[-1]
    whole = Block(first.start, last.stop, tuple(rows), first.width, first.heading)
    return [whole if block is first else block for block in blocks if block not in parts[1:]], (
        pattern
    )


def is_numbered(lines: Sequence[str]) -> bool:
    """Whether lines are titles of steps that are counted on and say no more: "Step 2", "Step 3".

    >>> is_numbered(["Step 2", "- Step 3 -"]), is_numbered(["Step 2: 10 rpm", "Step 3: 30 rpm"])
    (True, False)
    """
    titles = [_TITLE.fullmatch(line.strip()) for line in lines]
    numbers = [int(title["number"] or title["nth"]) for title in titles if title]
    rising = all(b == a + 1 for a, b in zip(numbers, numbers[1:], strict=False))
    return bool(numbers) and len(numbers) == len(lines) and rising


def further_words(lines: Sequence[str]) -> list[str] | None:
    """Return what titles of steps that are counted on say besides; None of other lines.

    >>> further_words(["--- Step 1/2  Speed 8 rpm ---", "--- Step 2/2  Speed 16 rpm ---"])
    ['  Speed 8 rpm ---', '  Speed 16 rpm ---']
    >>> further_words(["Results of the second part"])
    """
    titles = [_LONG_TITLE.match(line) for line in lines]
    numbers = [int(title["number"]) for title in titles if title]
    rising = all(b == a + 1 for a, b in zip(numbers, numbers[1:], strict=False))
    if not numbers or len(numbers) < len(lines) or not rising:
        return None
    return [title["rest"] for title in titles if title]


def _goes_on(lines: Sequence[str], parts: list[Block], grammar: Grammar) -> bool:
    """Whether each part is a piece of the same record: long, or later than the one before."""
    longest = max(len(part.rows) for part in parts)
    for earlier, later in zip(parts, parts[1:], strict=False):
        if len(later.rows) >= max(_FEW, _SHARE * longest):
            continue
        before, after = (grammar.cells(lines[row])[0] for row in (earlier.rows[-1], later.rows[0]))
        try:
            numbers = [float(cell.replace(grammar.decimal, ".")) for cell in (before, after)]
        except ValueError:
            return False
        if not numbers[1] > numbers[0]:
            return False
    return True


def _pattern(between: list[str], rows: list[str]) -> str | None:
    """Return a pattern of the lines between that no row of numbers matches."""
    starts = {line.lstrip()[:1] for line in between}
    if all(start.isascii() and start.isalpha() for start in starts):
        pattern = r"^\s*[A-Za-z]"
    else:
        pattern = r"^\s*[" + "".join(re.escape(start) for start in sorted(starts)) + "]"
    mark = re.compile(pattern)
    return None if any(mark.match(row) for row in rows) else pattern
