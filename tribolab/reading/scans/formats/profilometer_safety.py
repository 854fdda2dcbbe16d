"""Safety checks before a file is read by SurfaceTopography, whose readers trust files."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError

_MEGABYTE = 1 << 20
_BINARY = (b"PK\x03\x04", b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
# most lines, and most characters of a line, in text without a dialect
_MAX_LINES, _MAX_ROW = 2_000_000, 1 << 20
_HEADER_LINES = 200  # header lines that SurfaceTopography's column reader can skip
_MAX_LINE = 4096  # most bytes of a line with words, on which patterns take quadratic time
_NUMBERS = re.compile(rb"(?:[-+0-9.,;eE\s]|nan|NaN|bad|inf)*")
# SurfaceTopography's text formats in its order; "xyz" reads any line as a row, so it is tried only
# if the file ends with a table of numbers
_TEXT = ("sdf", "xyz", "asc")


def formats_to_try(path: Path, sure: list[str], possible: list[str]) -> list[str]:
    """Return the formats that SurfaceTopography may try on a file, in order.

    Parameters
    ----------
    path
        The file.
    sure, possible
        Formats of SurfaceTopography that the first bytes prove, and that they do not exclude.

    Raises
    ------
    ReadError
        If a zip archive or MAT file is damaged, or the file is text other than a profile.
    """
    with path.open("rb") as file:
        head = file.read(_MEGABYTE)
    if head.startswith(b"PK\x03\x04") and not zipfile.is_zipfile(path):
        raise ReadError(f"{path}: the zip or Office file is damaged; copy or save it again")
    if head.startswith(b"MATLAB 5.0"):
        _check_mat_file(path)
    elif head.startswith(_BINARY):
        pass
    elif b"\0" not in head or head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return list(dict.fromkeys([*sure, *_text_formats(path)]))
    # any file of twice a square number of bytes is a valid "hgt" map, which has no signature
    unmarked = {*_TEXT} if path.suffix.lower() == ".hgt" else {*_TEXT, "hgt"}
    every = dict.fromkeys([*sure, *possible])
    return [name for name in every if name not in unmarked or name in sure]


def _check_mat_file(path: Path) -> None:
    """Read a MAT file with our own reader first, which checks every size."""
    # imported late for a quick start
    from tribolab.reading.raw.containers.mat import read_variables

    if any(variable.numbers is None for variable in read_variables(path)):
        raise ReadError(
            f"{path}: the MAT file holds more than arrays of numbers; save the heights alone"
        )


def _text_formats(path: Path) -> list[str]:
    content = path.read_bytes()
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        content = content.decode("utf-16", errors="replace").encode()
    _refuse_endless_lines(path, content)
    lines = re.split(rb"\r\n|\r|\n", content)
    words = [number for number, line in enumerate(lines) if not _NUMBERS.fullmatch(line)]
    for number in words:
        if len(lines[number]) > _MAX_LINE:
            raise ReadError(
                f"{path}: line {number + 1} has {len(lines[number])} characters that are not all "
                "numbers; a profile's text has short lines of words; export it again"
            )
    last = words[-1] if words else -1
    widths = {_width(line) for line in lines[last + 1 :] if line.strip()}
    columns = last < _HEADER_LINES and len(widths) == 1 and None not in widths
    return [name for name in _TEXT if columns or name != "xyz"]


def _refuse_endless_lines(path: Path, content: bytes) -> None:
    """Raise if text has too many or too long lines for the memory."""
    count = content.count(b"\n") + content.count(b"\r")  # before creating a list of lines
    if count > _MAX_LINES:
        raise ReadError(
            f"{path}: {count} lines are more than a profile or map without a dialect may have "
            f"({_MAX_LINES}); describe the file in a TOML dialect"
        )
    letters = np.frombuffer(content, dtype=np.uint8)
    ends = np.flatnonzero((letters == ord("\n")) | (letters == ord("\r")))
    longest = int(np.diff(ends, prepend=-1, append=len(content)).max()) - 1
    if longest > _MAX_ROW:
        raise ReadError(
            f"{path}: a line of {longest} characters is longer than any row of a map "
            f"({_MAX_ROW}); export it with line ends"
        )


def _width(line: bytes) -> int | None:
    """Return the number of cells in a row of numbers; None for other rows."""
    cells = re.split(rb"[\s,;]+", line.strip())
    try:
        [float(cell) for cell in cells]
    except ValueError:
        return None
    return len(cells)
