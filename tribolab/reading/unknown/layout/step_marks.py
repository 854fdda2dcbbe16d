"""Tables of an unknown text file: where their rows are, and what steps are called."""

from __future__ import annotations

from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import alternatives
from tribolab.reading.unknown.layout.header import Heading

# what steps of a programme are called
STEP_WORD = alternatives("step")


class Block(NamedTuple):
    """Lines of numbers that follow one another; indices of lines count from 0."""

    start: int
    stop: int
    rows: tuple[int, ...]
    width: int
    heading: Heading | None
