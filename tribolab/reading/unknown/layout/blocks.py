"""Rows of numbers that belong together, and which of several tables is the main one."""

from __future__ import annotations

from collections import Counter

from tribolab.reading.unknown.layout.header import Block, find_heading
from tribolab.reading.unknown.layout.lines import Grammar


def find_blocks(lines: tuple[str, ...], grammar: Grammar) -> list[Block]:
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
        if rows and grammar.plain_width(line) == width:
            rows.append(index)
            continue
        cells = grammar.width(line)
        if cells and rows and grammar.is_footer(line) and not grammar.is_footer(lines[rows[0]]):
            cells = 0
        if not cells and rows and grammar.goes_on(line, width):
            cells = width
        if rows and cells > width and grammar.filled(line) <= width:
            cells = width  # delimiters too many at its end
        elif len(rows) == 1 and 0 < cells < width and grammar.filled(lines[rows[0]]) <= cells:
            width = cells  # so had the first row
        if cells != width and not (rows and index == last and 0 < cells < width):
            close()
            width = cells
        if cells == width and cells:
            rows.append(index)
    close()
    return blocks


def main_blocks(blocks: list[Block]) -> tuple[list[Block], int]:
    """Return the blocks under the same header with the most numbers; and the number of others.

    Blocks without a header count only if none of their width has one.
    """
    weight: Counter[tuple[tuple[str, ...] | None, int]] = Counter()
    headed = {block.width for block in blocks if block.heading is not None}
    for block in blocks:
        if block.heading is not None or block.width not in headed:
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
    # the order of columns may change from step to step if they have names
    cells = tuple(sorted(heading.cells)) if heading.aligned else heading.cells
    return cells, block.width
