"""Numbers of one column that go on from line to line: many stand in each."""

from __future__ import annotations

import re

_CELL = r"[-+]?[\d.,]*\d[\d.,]*(?:[eE][-+]?\d+)?"
_NUMBERS = {
    mark: re.compile(rf"[ \t]*{_CELL}(?:{gap}{_CELL})*(?:{gap})?[ \t\r]*")
    for mark, gap in (("whitespace", r"[ \t]+"), *((m, rf"[ \t]*\{m}[ \t]*") for m in ",;\t|"))
}


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
    numbers = _NUMBERS.get(delimiter)
    if numbers is None:
        return text
    mark = None if delimiter == "whitespace" else delimiter
    lines = []
    for line in text.split("\n"):
        if numbers.fullmatch(line):
            lines += [cell for cell in (part.strip() for part in line.split(mark)) if cell]
        else:
            lines.append(line)
    return "\n".join(lines)


def numbers_in(text: str, delimiter: str) -> int:
    """Return how many numbers stand in the lines that hold nothing else.

    Parameters
    ----------
    text, delimiter
        As for `unwrapped`.
    """
    numbers = _NUMBERS.get(delimiter)
    if numbers is None:
        return 0
    mark = None if delimiter == "whitespace" else delimiter
    rows = (line for line in text.split("\n") if numbers.fullmatch(line))
    return sum(1 for row in rows for part in row.split(mark) if part.strip())
