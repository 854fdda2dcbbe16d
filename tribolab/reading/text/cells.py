"""Cells of a line of text, and names and units in header cells."""

from __future__ import annotations

import re


def split_name(text: str) -> tuple[str, str | None]:
    """Split a header cell into the name and the unit in brackets (None without a unit).

    >>> split_name("Fx [N]")
    ('Fx', 'N')
    >>> split_name("COF")
    ('COF', None)
    """
    text = text.strip()
    start = max(text.rfind("["), text.rfind("("))
    unit = text[start + 1 : -1]
    if start < 0 or not text.endswith(("]", ")")) or "]" in unit or ")" in unit:
        return text, None
    return text[:start].strip(), unit.strip() or None


def split_row(line: str, delimiter: str) -> list[str]:
    """Return the cells of one line, without quotes and blanks around them.

    >>> split_row('1.5, "run, 2" ,3', ",")
    ['1.5', 'run, 2', '3']
    """
    if delimiter == "whitespace":
        cells = line.split()
    elif '"' in line:
        cells = _outside_quotes(line, delimiter)
    else:
        cells = line.split(delimiter)
    return [cell.strip().strip('"').strip() for cell in cells]


_QUOTED = re.compile(r'"[^"]*"')


def _outside_quotes(line: str, delimiter: str) -> list[str]:
    """Return the cells of a line with quotes, inside which delimiters are text."""
    texts = _QUOTED.findall(line)
    if not any(delimiter in text for text in texts):
        return line.split(delimiter)
    cells = [""]
    for part, text in zip(_QUOTED.split(line), [*texts, ""], strict=True):
        first, *more = part.split(delimiter)
        cells[-1] += first
        cells += more
        cells[-1] += text
    return cells
