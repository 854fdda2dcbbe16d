"""Excerpt of a long text file: whole lines from its start, its end and places in between."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from tribolab.reading.text.first_bytes import wide_encoding

_MAX_WHOLE = 1 << 26  # largest size of a file that is read as a whole [bytes]
_START, _PIECE, _PIECES = 1 << 18, 1 << 11, 512  # start and piece size [bytes]; number of pieces
_MAX_LINE = 1 << 16  # largest length of a line [bytes]


class Excerpt(NamedTuple):
    """Excerpt of a file, its number of lines, and the estimated number in the whole file."""

    file: Path
    lines: int
    lines_of_whole: int


def write_excerpt(path: Path, folder: Path) -> Excerpt | None:
    """Write an excerpt of a long text file into a folder, under the same name.

    Parameters
    ----------
    path
        The file.
    folder
        An empty folder.

    Returns
    -------
    Excerpt or None
        None if the file is short, binary, in a two-byte encoding, or has very long lines.
    """
    if not path.is_file() or (size := path.stat().st_size) <= _MAX_WHOLE:
        return None
    with path.open("rb") as source:
        start = source.read(_START)
        if b"\0" in start or wide_encoding(start):
            return None
        parts = [start + source.readline(_MAX_LINE)]
        step = (size - _START - _PIECE) // _PIECES
        for number in range(1, _PIECES + 1):
            source.seek(_START + number * step if number < _PIECES else size - _PIECE)
            source.readline(_MAX_LINE)
            last = number == _PIECES
            parts.append(source.read(_PIECE) + (b"" if last else source.readline(_MAX_LINE)))
    if not all(part.endswith(b"\n") for part in parts[:-1]):
        return None
    file = folder / path.name
    file.write_bytes(b"".join(parts))
    lines = [part.count(b"\n") for part in parts]
    beyond = sum(lines[1:]) / sum(map(len, parts[1:])) * (size - len(parts[0]))
    return Excerpt(file, sum(lines), lines[0] + round(beyond))
