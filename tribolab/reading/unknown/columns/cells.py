"""Numbers and words in the cells of an unknown table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.raw.missing_marks import LARGEST, take_marks
from tribolab.reading.text.cells import split_row
from tribolab.reading.unknown.layout.text_layout import Layout

_LONGEST_WORD = 30  # characters
_MAX_WORDS = 10  # different words for a missing value


class Cells(NamedTuple):
    """Contents of the cells of a table.

    Attributes
    ----------
    numbers
        Of all rows (rows, columns); NaN for what is none.
    text
        For each column one of its words if most of its cells are words, else "".
    missing
        For each column its words for a missing value.
    """

    numbers: np.ndarray
    text: list[str]
    missing: list[list[str]]


def read_cells(layout: Layout) -> Cells:
    """Return the numbers and words of all rows of a table."""
    width = layout.width
    text, missing = [""] * width, [list[str]() for _ in range(width)]
    if layout.numbers is not None:
        return Cells(_measured(layout.numbers.copy()), text, missing)
    rows = [split_row(line, layout.delimiter) for line in layout.rows()]
    numbers = np.empty((len(rows), width))
    for place in range(width):
        cells = [row[place] if place < len(row) else "" for row in rows]
        numbers[:, place], words = _numbers_and_words(cells, layout.decimal)
        if 2 * len(words) > sum(map(bool, cells)):
            text[place] = words[0][:_LONGEST_WORD]
        else:
            missing[place] = list(dict.fromkeys(words))[:_MAX_WORDS]
    return Cells(_measured(numbers), text, missing)


def _numbers_and_words(cells: Sequence[str], decimal: str) -> tuple[np.ndarray, list[str]]:
    """Return the numbers of a column, NaN for other cells, and its words.

    >>> _numbers_and_words(["1,5", "", "err", "NaN"], ",")
    (array([1.5, nan, nan, nan]), ['err'])
    """
    numbers, words = np.full(len(cells), np.nan), []
    for row, cell in enumerate(cells):
        try:
            numbers[row] = float(cell.replace(decimal, ".") if "_" not in cell else "no number")
        except ValueError:
            if cell:
                words.append(cell)
    return numbers, words


def _measured(numbers: np.ndarray) -> np.ndarray:
    """Return numbers without no-data values, which the reader omits."""
    numbers[np.abs(numbers) > LARGEST] = np.nan
    for values in numbers.T:
        take_marks([values])
    return numbers
