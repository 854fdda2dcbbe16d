"""Check for text with far too long rows or header, before any reader searches for tables."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from tribolab.reading.raw import limits
from tribolab.reading.raw.opening import RefusedError

_BETWEEN = np.isin(np.arange(256), np.frombuffer(b" \t,;\r\n\0", dtype=np.uint8))
# line that begins or ends with a number, or has two numbers
_ROW = re.compile(
    rb"^[ \t\"'({\[]*[-+.,]?\d|\d[.,]?[ \t\"',;\r]*$|\d[ \t,;:|][^\n]*\d", re.MULTILINE
)


def refuse_endless(path: Path, head: bytes, size: int) -> None:
    """Raise if rows of a text have too many cells, or its header exceeds a megabyte.

    Parameters
    ----------
    path, head, size
        The file, its first bytes (at most a megabyte), and its size.

    Raises
    ------
    RefusedError
        If two lines (or one that exceeds the head) have more cells than any map, or if the head
        of a longer file has no row of numbers.
    """
    letters = np.frombuffer(head, dtype=np.uint8)
    ends = np.flatnonzero(letters == ord("\n"))
    ends = ends if ends.size else np.flatnonzero(letters == ord("\r"))
    longest = int(np.diff(ends, prepend=0, append=letters.size).max())
    wide = np.array([], int)
    if longest > 2 * limits.COLUMNS_OF_TEXT.value:  # a cell has at least two bytes
        between = _BETWEEN[letters]
        before = np.concatenate(([True], between[:-1]))
        starts = np.flatnonzero(before & ~between)  # of cells
        cells = np.bincount(np.searchsorted(ends, starts), minlength=1)
        wide = cells[cells > limits.COLUMNS_OF_TEXT.value]
    if wide.size > 1 or (wide.size and not ends.size and len(head) < size):
        raise RefusedError(
            f"some {wide[0]} columns are more than a measurement or a map has "
            f"({limits.COLUMNS_OF_TEXT.value:.0f})",
            where=path,
            cure="save those of the run in a file of their own; is each row on a line of its own?",
        )
    if len(head) < size and not _ROW.search(head.replace(b"\0", b"")):
        raise RefusedError(
            "no line of the first megabyte is a row of numbers",
            where=path,
            cure="remove what stands above the table",
        )
