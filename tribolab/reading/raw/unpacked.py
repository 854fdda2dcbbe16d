"""Compressed files: checked against zip bombs, unpacked once per process, then read like others."""

from __future__ import annotations

import dataclasses
import functools
import gzip
import re
import stat
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Protocol

from tribolab.core.errors import Cure, ReadError, TribolabError, brief, shown
from tribolab.reading.raw.opening import RefusedError, largest_unpacked
from tribolab.reading.raw.scratch import scratch_errors, scratch_folder
from tribolab.reading.raw.xml_safety import refuse_deep

_GZIP, ZIP = b"\x1f\x8b", b"PK\x03\x04"
_OFFICE = ("[Content_Types].xml", "main.xml")  # Office files and x3p are also archives
_CHUNK = 1 << 20
_MAX_DEFLATED = 1032  # highest compression ratio of zlib (zlib.net/zlib_tech.html)
_STATED = 4  # bytes at the end of a gzip file that state its unpacked size, modulo 4 GiB
_MAX_README = 1 << 16  # bytes of the longest readme that is used
_MAX_LETTER = 3  # bytes of an incomplete character at the end of a block
# files in an archive besides data: readmes, pictures, system files
_README = re.compile(
    r"(?:^|/)[^/]*(?:read[ _-]?me|lies[ _-]?mich|l[ie]s?ez[ _-]?moi|leeme|leggimi|leia[ _-]?me|info"
    r"|about|notes?|notizen?|description|beschreibung|codebook)[^/]*\.(?:txt|md|rst|asc)$"
    r"|(?:^|/)read[ _-]?me$|\.(?:md|rst)$",
    re.IGNORECASE,
)
_DOCUMENT = re.compile(
    rf"{_README.pattern}|(?:^|/)\.[^/]+$|(?:^|/)(?:thumbs\.db|desktop\.ini|licen[cs]e[^/]*|copying"
    r"|checksums?[^/]*|manifest[^/]*|md5sums?[^/]*|sha256sums?[^/]*)$"
    r"|\.(?:pdf|docx?|odt|rtf|html?|png|jpe?g|gif|svg|bmp|tiff?|md5|sha1|sha256|py|m|r|ipynb)$",
    re.IGNORECASE,
)


class _Source(Protocol):
    def read(self, size: int = -1, /) -> bytes: ...


def unpacked(path: Path, head: bytes) -> Path:
    """Return the path of the unpacked content of a compressed file; of another file its own path.

    Parameters
    ----------
    path
        The file.
    head
        First bytes of the file.

    Raises
    ------
    ReadError
        If the file is damaged, or an archive of several files.
    """
    if head.startswith(_GZIP):
        state = path.stat()
        return _unpacked(path.resolve(), state.st_size, state.st_mtime_ns, "gz")
    if head.startswith(ZIP) and _members(path) is not None:
        state = path.stat()
        return _unpacked(path.resolve(), state.st_size, state.st_mtime_ns, "zip")
    return path


def of_the_file(error: ReadError, inside: Path, path: Path) -> ReadError:
    """Return an error about an unpacked file, reworded for the compressed file that the user named.

    >>> error = ReadError("/tmp/u/a.csv: no heights", cure="describe 'a.csv'")
    >>> print(of_the_file(error, Path("/tmp/u/a.csv"), Path("raw/a.csv.gz")))
    raw/a.csv.gz: no heights; describe 'a.csv.gz'
    """

    def renamed(text: str) -> str:
        parts = text.split(str(inside))
        return str(path).join(part.replace(inside.name, path.name) for part in parts)

    cure = error.cure
    if isinstance(cure, Cure):
        cure = Cure(*(renamed(words) for words in dataclasses.astuple(cure)))
    else:
        cure = renamed(cure)
    what = error.what if isinstance(error.what, TribolabError) else renamed(error.what)
    return ReadError(what, where=renamed(error.where), function=error.function, cure=cure)


def has_arrays(path: Path) -> bool:
    """Whether an archive contains only NumPy arrays."""
    names = _names(path)
    return bool(names) and all(name.endswith(".npy") for name in names)


def is_workbook(path: Path) -> bool:
    """Whether an archive is an Excel workbook."""
    return any(name.startswith("xl/workbook") for name in _names(path))


def _names(path: Path) -> list[str]:
    """Return the names of all members of an archive; empty if it cannot be opened."""
    try:
        with zipfile.ZipFile(path) as archive:
            return archive.namelist()
    except ZIP_DAMAGE:
        return []


def _members(path: Path) -> list[str] | None:
    """Return the names of the files in a plain archive; None for Office files, x3p and NumPy."""
    try:
        with zipfile.ZipFile(path) as archive:
            parts = [info for info in archive.infolist() if not info.is_dir()]
            names = [info.filename for info in parts]
    except ZIP_DAMAGE:
        return None
    if any(name.split("/")[-1] in _OFFICE for name in names):
        return None
    if has_arrays(path):
        return None  # an archive of NumPy arrays is read as a whole
    for part in parts:
        _refuse_outside(path, part)
    return [name for name in names if not name.startswith("__MACOSX/")]


def _refuse_outside(path: Path, part: zipfile.ZipInfo) -> None:
    """Raise if a member is a link, or its name leads outside the archive."""
    name = part.filename.replace("\\", "/")
    outside = name.startswith("/") or name[1:2] == ":" or ".." in name.split("/")
    if outside or stat.S_ISLNK(part.external_attr >> 16):
        what = "has a name outside of it" if outside else "is a link"
        raise ReadError(
            f"'{shown(part.filename, 60)}' in this archive {what}; tribolab reads no data from "
            "outside a file",
            where=path,
            cure="pack the files themselves again",
        )


@functools.lru_cache(maxsize=64)
def _unpacked(path: Path, size: int, modified: int, kind: str) -> Path:
    folder = scratch_folder()
    try:
        if kind == "gz":
            target = folder / (path.stem if path.suffix.lower() in (".gz", ".z") else path.name)
            with path.open("rb") as file:
                file.seek(-_STATED, 2)
                stated = int.from_bytes(file.read(), "little")
            if stated > _MAX_DEFLATED * size:
                raise zlib.error("its last bytes state more than it can hold")
            _refuse_larger(stated, size, path)
            with gzip.open(path) as source:
                _copy(source, target, size, path)
            return target
        every = _members(path) or []
        names = [name for name in every if not _DOCUMENT.search(name)] or every
        if len(names) != 1:
            listed = ", ".join(shown(name, 40) for name in names[:5])
            raise ReadError(
                f"this archive holds {len(names)} files ({listed}); unpack it, and name the raw "
                "files",
                where=path,
            )
        target = folder / (Path(names[0]).name or "content")
        with zipfile.ZipFile(path) as archive, archive.open(names[0]) as source:
            _refuse_larger(archive.getinfo(names[0]).file_size, size, path)
            first = source.read(_CHUNK)
            above = _readme_text(archive, [name for name in every if name != names[0]], first)
            _copy(_Chained(above + first, source), target, size, path)
        return target
    except ZIP_DAMAGE as error:
        raise ReadError(f"this compressed file is damaged: {brief(error)}", where=path) from error


def _readme_text(archive: zipfile.ZipFile, names: list[str], first: bytes) -> bytes:
    """Return the readmes of an archive, which are read as a header above its text table."""
    if b"\0" in first or not _is_utf8(first):
        return b""
    texts = []
    for name in names:
        if not _README.search(name) or archive.getinfo(name).file_size > _MAX_README:
            continue
        text = archive.read(name).removeprefix(b"\xef\xbb\xbf")
        if b"\0" not in text and _is_utf8(text) and text.strip():
            texts.append(text.rstrip() + b"\n\n")
    return b"".join(texts)


def _is_utf8(text: bytes) -> bool:
    try:
        text[: -_MAX_LETTER if len(text) == _CHUNK else None].decode()
    except UnicodeDecodeError:
        return False
    return True


class _Chained:
    """Stream of bytes already read, followed by the rest of a file."""

    def __init__(self, first: bytes, rest: _Source):
        self._first, self._rest = first, rest

    def read(self, size: int = -1, /) -> bytes:
        first, self._first = self._first, b""
        return first or self._rest.read(size)


def _copy(source: _Source, target: Path, size: int, path: Path) -> None:
    """Copy unpacked data, and stop if it exceeds the limit."""
    done = 0
    with target.open("wb") as file:
        while part := source.read(_CHUNK):
            done += len(part)
            _refuse_larger(done, size, path)
            with scratch_errors():
                file.write(part)
                file.flush()


def _refuse_larger(unpacked: int, size: int, path: Path) -> None:
    if unpacked > largest_unpacked(size):
        raise ReadError(
            f"this compressed file of {size / 1e6:.2g} MB unpacks to {unpacked / 1e6:.0f} MB or "
            "more: that is no measurement",
            where=path,
        )


# exceptions of zipfile for damaged, encrypted or unsupported archives
ZIP_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, struct.error, OSError, EOFError, RuntimeError, ValueError),
)


def refuse_bomb(path: Path) -> None:
    """Raise if an archive unpacks to far more than its size, or has XML that is nested too deeply.

    Raises
    ------
    RefusedError
        If the archive exceeds a limit.
    """
    size = path.stat().st_size
    with zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        unpacked = sum(member.file_size for member in members)
        if unpacked > largest_unpacked(size):
            raise RefusedError(
                f"{path}: the file unpacks to {unpacked / 1e6:.0f} MB, {unpacked / size:.0f} times "
                "its size; that is no measurement. Export the data as text (csv)"
            )
        for member in members:
            if member.filename.lower().endswith((".xml", ".rels")):
                with archive.open(member) as file:
                    refuse_deep(path, member.filename, _blocks(file))


def _blocks(file: IO[bytes]) -> Iterator[bytes]:
    while block := file.read(_CHUNK):
        yield block
