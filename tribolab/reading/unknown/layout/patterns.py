"""Patterns in a drafted dialect that find headers, step numbers and the end of a table."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.reading.dialect.delimited.normalised_text import line_feeds
from tribolab.reading.numbers import escaped
from tribolab.reading.text.bounded_patterns import MAX_PATTERN
from tribolab.reading.text.first_bytes import HEAD, File
from tribolab.reading.unknown.layout.header import STEP_WORD, Block, first_cells
from tribolab.reading.unknown.layout.lines import Grammar

_TAIL = 1 << 14  # bytes at the end of a file
_TRIED = 20  # patterns of step numbers that are tried


def header_pattern(
    lines: tuple[str, ...], blocks: list[Block], grammar: Grammar
) -> tuple[str | None, bool]:
    """Return a pattern that matches only the header lines, and whether there are several."""
    wanted = [block.heading.names for block in blocks if block.heading]
    headers = list(dict.fromkeys(lines[index] for index in wanted))
    repeats = len(wanted) > 1
    if wanted == [0]:
        return None, False
    spaced = grammar.delimiter == "whitespace"  # the reader then removes leading blanks
    for short in (True, False):
        texts = [
            escaped(first_cells(line, grammar.delimiter) if short else line.strip() or line)
            for line in headers
        ]
        texts = list(dict.fromkeys(texts))
        pattern = "^" + (texts[0] if len(texts) == 1 else f"(?:{'|'.join(texts)})")
        matched = [
            i
            for i, line in enumerate(lines)
            if re.match(pattern, line.lstrip() if spaced else line)
        ]
        if len(pattern) > MAX_PATTERN:  # too long for a dialect
            continue
        if matched == wanted or (not repeats and matched[:1] == wanted):
            return pattern, repeats
    return None, False


def step_pattern(lines: tuple[str, ...], blocks: list[Block]) -> str | None:
    """Return a pattern that finds the step number in the text before each header, or None."""
    texts, done = [], 0
    for block in blocks:
        texts.append(lines[done : block.heading.names if block.heading else block.start])
        done = block.stop
    tried: set[str] = set()
    for line in texts[0]:
        title = re.match(rf"(?i)(\W*(?:[a-z]+ ?- ?|{STEP_WORD}\D{{0,5}}))(\d+)\b", line)
        title = title or re.match(r"(.* - )(\d+)$", line)
        if not title:
            continue
        general = r"^.* - (\d+)$" if title[1].endswith(" - ") else f"^{escaped(title[1])}(\\d+)"
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


def last_lines(file: File, encoding: str) -> list[str]:
    """Return the last lines of a file that is larger than the inspected first megabyte."""
    if file.size <= HEAD:
        return []
    with file.path.open("rb") as handle:
        handle.seek(max(file.size - _TAIL, HEAD))
        text = handle.read().decode(encoding, errors="replace")
    return line_feeds(text).split("\n")[1:]


def end_pattern(
    lines: tuple[str, ...], blocks: list[Block], tail: list[str], grammar: Grammar
) -> str | None:
    """Return a pattern for the first line of text below the table; None if there is no text."""
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
