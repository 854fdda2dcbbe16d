"""Line numbers of keys in a TOML text, for error messages."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence

_HEADER = re.compile(r"^\s*(\[\[?)\s*(.+?)\s*\]\]?\s*(?:#.*)?$")
_KEY = re.compile(r"^\s*((?:[A-Za-z0-9_-]+|\"[^\"]*\"|'[^']*')(?:\s*\.\s*[A-Za-z0-9_-]+)*)\s*=")
_PART = re.compile(r"\"([^\"]*)\"|'([^']*)'|([^\s.\"']+)")


def _parts(dotted: str) -> tuple[str, ...]:
    return tuple(next((text for text in match if text), "") for match in _PART.findall(dotted))


def line_of(text: str, where: Sequence[str | int]) -> int | None:
    r"""Return the line (from 1) of the key at `where`, or of the nearest table above it.

    Parameters
    ----------
    text
        A TOML text.
    where
        Path of the key: names of tables and keys, and numbers of the elements of lists.

    Returns
    -------
    int or None
        The line; None if the text does not contain the first part of the path.

    Examples
    --------
    >>> line_of('[[run]]\nfiles = "a"\n[[run]]\nfiles = "b"\n', ["run", 1, "files"])
    4
    """
    lines = _lines(text)
    for length in range(len(where), 0, -1):
        if tuple(where[:length]) in lines:
            return lines[tuple(where[:length])]
    return None


@functools.lru_cache(maxsize=2)  # called with the same text for every mistake in it
def _lines(text: str) -> Mapping[tuple[str | int, ...], int]:
    """Return the line of each table and key of a text, by its path."""
    lines: dict[tuple[str | int, ...], int] = {}
    table: tuple[str | int, ...] = ()
    counts: dict[tuple[str | int, ...], int] = {}
    fence = ""  # delimiter of the multi-line text around this line, in which there are no keys
    for number, line in enumerate(text.splitlines(), start=1):
        if fence:
            if line.count(fence) % 2:
                fence = ""
            continue
        if header := _HEADER.match(line):
            table = ()
            for part in _parts(header[2]):
                table += (part,)
                if table in counts and table != _parts(header[2]):
                    table += (counts[table],)
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                lines.setdefault(table, number)
                table += (counts[table],)
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            lines.setdefault(table + _parts(key[1]), number)
        fence = next((f for f in ('"""', "'''") if line.count(f) % 2), "")
    return lines
