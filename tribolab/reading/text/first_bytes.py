"""First inspection of a file: whether it can be read, and its format."""

from __future__ import annotations

import functools
import json
import re
from pathlib import Path
from typing import NamedTuple

from tribolab.core.errors import ReadError
from tribolab.reading import cures
from tribolab.reading.file_patterns import why_missing
from tribolab.reading.raw.containers.declared_records import declares_records
from tribolab.reading.raw.containers.xml_workbook import is_xml_workbook
from tribolab.reading.raw.hdf5_safety import check_self_contained
from tribolab.reading.raw.opening import MissingLibraryError, RefusedError
from tribolab.reading.raw.readers import answers, installed_readers
from tribolab.reading.raw.source import Identity, check_regular, identity_of
from tribolab.reading.raw.unpacked import ZIP, has_arrays, is_workbook, unpacked
from tribolab.reading.results_table import find_other_test, find_results_table
from tribolab.reading.text.endless import refuse_endless

HEAD = 1 << 20  # bytes read for preamble and header

_MAGIC = {
    b"MATLAB 5.0": "mat",
    b"TDSm": "tdms",
    b"\x89HDF\r\n\x1a\n": "netcdf",
    b"CDF\x01": "netcdf",
    b"CDF\x02": "netcdf",
    b"MATLAB 7.3": "hdf5",
    b"PAR1": "parquet",
    b"ARROW1": "feather",
    b"FEA1": "feather",
    b"\xd0\xcf\x11\xe0": "excel",
}
_JSON = re.compile(rb'(?:\xef\xbb\xbf)?\s*(?:\{\s*"[^"]*"\s*:|\[\s*[\[{])')
_COMPATIBLE_FORMATS = {
    ("netcdf", "hdf5"),
    ("text", "binary"),
    ("text", "json"),
    ("text", "declared records"),
}  # formats of file and dialect that differ, but are compatible
_FOREIGN = {b"PK\x03\x04": "a zip or Office file; export a table as text (csv)", b"%PDF": "a PDF"}
_PERHAPS_PROFILE = (b"PK\x03\x04",)
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_WIDE_HEAD = 4096  # bytes that suffice to recognise two-byte characters
_MIN_BYTES = 64


class File(NamedTuple):
    """Readable file with path, format, size and first bytes."""

    path: Path
    format: str
    size: int
    head: bytes

    @property
    def container(self) -> str:
        """Format with named columns, also JSON and records declared in text; "" for other text."""
        if self.format != "text":
            return self.format
        if _is_json(self.head):
            return "json"
        return "declared records" if b"\0" in self.head and not wide_encoding(self.head) else ""


def peek(path: str | Path, *, binary: bool = False) -> File:
    """Inspect the start of a file; for a compressed file, of its content.

    Parameters
    ----------
    path
        The file.
    binary
        Whether an unknown binary format is accepted, because a dialect describes it.

    Raises
    ------
    ReadError
        If the file does not exist, is not regular, is empty, or has an unreadable format.
    """
    path = Path(path)
    known = identity_of(path)
    return _seen(path, binary, None) if known is None else _seen_at_rest(path, binary, known)


def _seen(path: Path, binary: bool, _: Identity | None) -> File:
    try:
        if path.exists():
            check_regular(path)
        with path.open("rb") as file:
            head = file.read(HEAD)
            size = file.seek(0, 2)
    except FileNotFoundError as error:
        raise ReadError(f"{path}: {why_missing(path)}") from error
    except (OSError, ValueError) as error:  # ValueError: NUL in the path
        raise ReadError(f"{path}: the file cannot be opened: {error}") from error
    inner = unpacked(path, head)
    if inner != path:
        return _seen(inner, False, None)
    wide = bool(wide_encoding(head))
    if not head.strip(b"\xef\xbb\xbf \t\r\n" + b"\xff\xfe\0" * wide):
        raise ReadError(f"{path}: the file is empty")
    found = File(path, _format(path, head, binary=binary), size, head)
    if found.format == "text" and not found.container:
        refuse_endless(path, head, size)
    if found.format in ("hdf5", "netcdf"):
        try:
            check_self_contained(path)
        except (RefusedError, MissingLibraryError):
            raise
        except ReadError:  # the file is damaged; its reader reports details
            pass
    return found


_seen_at_rest = functools.lru_cache(maxsize=4)(_seen)  # files are inspected repeatedly


def wide_encoding(head: bytes) -> str:
    """Return the encoding of text with two-byte characters; "" for other text.

    Without a byte order mark, the same byte of nearly every character is zero.

    >>> wide_encoding("Zeit [s]".encode("utf-16-le") * 9), wide_encoding(b"Zeit [s]" * 9)
    ('utf-16-le', '')
    """
    if head.startswith(_UTF16):
        return "utf-16"
    first = head[:_WIDE_HEAD]
    if len(first) < _MIN_BYTES or b"\0" not in first:
        return ""
    for name, zeros, letters in (
        ("utf-16-le", first[1::2], first[::2]),
        ("utf-16-be", first[::2], first[1::2]),
    ):
        often = zeros.count(0) > 0.9 * len(zeros) and 0 not in letters
        # printable characters instead of small two-byte numbers
        plain = sum(byte >= 32 or byte in b"\t\r\n" for byte in letters)
        if often and plain == len(letters):
            return name
    return ""


def fits_format(format_of_file: str, format_of_dialect: str) -> bool:
    """Whether a file's format is compatible with that of a dialect.

    >>> fits_format("netcdf", "hdf5"), fits_format("text", "mat")
    (True, False)
    """
    return (
        format_of_file == format_of_dialect
        or (format_of_file, format_of_dialect) in _COMPATIBLE_FORMATS
    )


_MAX_JSON = 1 << 28  # bytes, as a JSON file is read as a whole


def _is_json(head: bytes) -> bool:
    """Whether a file is JSON as a whole, not a table below a line of JSON."""
    if not _JSON.match(head):
        return False
    text = head.decode("utf-8-sig", errors="replace").lstrip()
    try:
        end = json.JSONDecoder().raw_decode(text)[1]
    except (ValueError, RecursionError):  # the JSON text exceeds the head, or is nested too deeply
        return True
    return not text[end:].strip(" \t\r\n,") or text[end:].lstrip()[0] in "{[,"


def _format(path: Path, head: bytes, *, binary: bool) -> str:
    for magic, name in _MAGIC.items():
        if head.startswith(magic):
            return name
    if (head.startswith(ZIP) and is_workbook(path)) or is_xml_workbook(head):
        return "excel"
    if head.startswith(ZIP) and has_arrays(path):
        return "npz"
    if binary and b"\0" in head:
        return "binary"
    for magic, name in _FOREIGN.items():
        if head.startswith(magic):
            profile = magic in _PERHAPS_PROFILE
            raise ReadError(
                f"this is {name}", where=path, cure=cures.PERHAPS_PROFILE if profile else ""
            )
    if b"\0" in head and not wide_encoding(head):
        if declares_records(head):
            return "text"
        if installed_readers() and answers(head):
            return "python"
        raise ReadError(
            "this is neither text nor a binary format that is known",
            where=path,
            cure=cures.PERHAPS_PROFILE,
        )
    if _is_json(head) and not _has_columns(path):
        cure = "write its columns as a table, e.g. in Python pandas.DataFrame(...).to_csv(...)"
        raise ReadError("this is JSON, of which no table is read", where=path, cure=cure)
    return "text"


def _has_columns(path: Path) -> bool:
    try:
        state = path.stat()
    except OSError:
        return False
    return state.st_size <= _MAX_JSON and _has_tables(path, state.st_size, state.st_mtime_ns)


@functools.lru_cache(maxsize=16)  # a file is inspected more than once
def _has_tables(path: Path, size: int, changed: int) -> bool:
    # imported late for a quick start
    from tribolab.reading.raw.containers.json_tables import has_tables

    try:
        return has_tables(path.read_text("utf-8-sig"))
    except (OSError, UnicodeDecodeError):
        return False


_MODE = re.compile(r"^Mode;RES\s*$", re.MULTILINE)


# name, value (asterisks if not computed) and unit of a roughness parameter
_NAMED = re.compile(
    r"^\s*(?P<name>[RPWS](?:a|q|z|t|p|v|c|sk|ku|dq|\u0394q|Sm|z1max|max|3z|k|pk|vk)\d?|(?:\u03bb|[Ll])[cs]"
    r"|[Cc]ut-? ?off)\s*[:=;,\t ]\s*(?P<value>[-+]?\d+(?:[.,]\d+)?|\*[.,*]*\*)"
    r"\s*[;,\t]?\s*(?P<unit>[^\s\d;,*][^\s;,]*)?\s*[;,]*\s*$"
)
_MIN_LINES, _MAX_LINES = 3, 200  # smallest and largest number of result lines


def is_results(head: bytes) -> bool:
    """Whether the first bytes of a file look like test results instead of signals."""
    return results_error(head, Path()) is not None


def results_error(head: bytes, where: Path) -> ReadError | None:
    """Return the error for a file of results where signals are expected; else None."""
    if is_surftest_results(head) or len(named_values(head)) >= _MIN_LINES:
        what = "the file holds the results of a roughness tester, but no profile"
        return ReadError(what, where=where, cure=cures.TESTER_RESULTS)
    text = text_of(head) if b"\0" not in head[:4096] else ""
    if test := find_other_test(text):
        cure = "a run needs a friction force and a load, a scan heights"
        return ReadError(f"the file holds {test}: no friction is in it", where=where, cure=cure)
    table = find_results_table(text)
    if table is None:
        return None
    cure = "export the profiles, or the records over time"
    return ReadError(f"the file holds {table.words}", where=where, cure=cure)


def text_of(raw: bytes) -> str:
    """Decode bytes as UTF-16 if they look like it, else as UTF-8 or Windows-1252."""
    if wide := wide_encoding(raw):
        return raw.decode(wide, errors="replace").removeprefix("\ufeff")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def is_surftest_results(head: bytes) -> bool:
    """Whether a file begins like a Surftest results file."""
    text = head[:4096].decode("latin-1").replace("\r", "")
    return text.startswith("// Header") and _MODE.search(text) is not None


def named_values(head: bytes) -> list[tuple[int, tuple[str, str, str]]]:
    r"""Return the roughness parameters in a text: line number from 1, and name, value, unit.

    The list is empty if most lines are something else, e.g. a profile below its results.

    Examples
    --------
    >>> named_values(b"Ra = 0.52 um\nRz\t*.***um\nRsk;-0,31\n")[1:]
    [(2, ('Rz', '*.***', 'um')), (3, ('Rsk', '-0,31', ''))]
    """
    if head.count(b"\n") > _MAX_LINES or b"\0" in head[:4096]:
        return []
    lines = text_of(head).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    entries = [(n, match) for n, line in enumerate(lines, 1) if (match := _NAMED.match(line))]
    if 2 * len(entries) < sum(bool(line.strip()) for line in lines):
        return []
    return [(n, (match["name"], match["value"], match["unit"] or "")) for n, match in entries]
