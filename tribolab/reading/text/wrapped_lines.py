"""Numbers of one column that go on from line to line: many stand in each."""

from __future__ import annotations

import re

_CELL = re.compile(r"[-+]?[.,]*\d[\d.,]*(?:[eE][-+]?\d+)?")
_MARKS = {"whitespace": None, **{mark: mark for mark in ",;\t|"}}


def unwrapped(text: str, delimiter: str) -> str:
    r"""Return a text with a line for each number of the lines that hold nothing but numbers.

    Parameters
    ----------
    text
        The table.
    delimiter
        What parts the numbers of a line: "whitespace", or one character.

    Examples
    --------
    >>> unwrapped("2 profiles\n1.5 2.5 3.5\n4.5\n", "whitespace").splitlines()
    ['2 profiles', '1.5', '2.5', '3.5', '4.5']
    """
    if delimiter not in _MARKS:
        return text
    lines: list[str] = []
    for line in text.split("\n"):
        lines += _numbers(line, _MARKS[delimiter]) or [line]
    return "\n".join(lines)


def numbers_in(text: str, delimiter: str) -> int:
    """Return how many numbers stand in the lines that hold nothing else.

    Parameters
    ----------
    text, delimiter
        As for `unwrapped`.
    """
    if delimiter not in _MARKS:
        return 0
    return sum(len(_numbers(line, _MARKS[delimiter])) for line in text.split("\n"))


def _numbers(line: str, mark: str | None) -> list[str]:
    """Return the numbers of a line that holds nothing else; the last may have a mark behind it."""
    cells = [cell.strip() for cell in line.split(mark)]
    cells = cells[:-1] if len(cells) > 1 and not cells[-1] else cells
    return cells if all(map(_CELL.fullmatch, cells)) else []
