"""Catalogue of a campaign: record of every part, with the fingerprint of its inputs.

The catalogue is an SQLite file in the results folder with one row for each run, curve, surface,
model and figure: a small outcome, the complete record as compressed JSON, and the trace shown on
the page. Tables, page, report.json and the next run are made from it without opening a data file.
The catalogue also identifies every file that was read, so that unchanged files are recognised by
size, time and inode without reading them again.
"""

from __future__ import annotations

import contextlib
import os
import sqlite3
import weakref
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

from pydantic import TypeAdapter, ValidationError

from tribolab.core.provenance import sha256_of
from tribolab.records.parts import PageTrace

CATALOGUE = "catalogue.sqlite"
FORMAT = "1"
MAX_RECORD = 1 << 28  # bytes: a run of 10 000 cycles has 20 MB
Kept = TypeVar("Kept")


def fingerprint_of(config_sha256: str) -> str:
    """Return the checksum of settings and version, i.e. of all inputs except files."""
    # imported late: looks up the installed package
    from tribolab.version import __version__

    return sha256_of([__version__, config_sha256])


class Entry(NamedTuple, Generic[Kept]):
    """Record of a part, with its name and the fingerprint of its inputs."""

    name: str
    fingerprint: str
    record: Kept


class Catalogue:
    """Read access to the records of a results folder.

    Parameters
    ----------
    known
        Open catalogue; None is empty.
    """

    def __init__(self, known: sqlite3.Connection | None) -> None:
        self._known = known
        if known is not None:  # close it when this object is garbage-collected
            weakref.finalize(self, known.close)

    @classmethod
    def of(cls, folder: Path | None) -> Catalogue:
        """Open the catalogue of a results folder.

        A missing or damaged catalogue, or one of another format, counts as empty.
        """
        return Catalogue(_open_catalogue(folder))

    def get(self, kind: str, name: str, record: type[Kept]) -> Entry[Kept] | None:
        """Return the entry of one run, curve, surface, model or figure; None if it is unknown."""
        rows = self._rows(f"{_SELECT} WHERE kind=? AND name=?", (kind, name))
        return next(_entries(rows, record), None)

    def all(self, kind: str, record: type[Kept]) -> Iterator[Entry[Kept]]:
        """Yield all parts of a kind in order, without keeping them in memory."""
        rows = self._rows(f"{_SELECT} WHERE kind=? ORDER BY place", (kind,))
        return _entries(rows, record)

    def outcomes(self, kind: str, outcome: type[Kept]) -> list[Kept]:
        """Return the outcomes of the parts of a kind, in order."""
        rows = self._rows("SELECT outcome FROM part WHERE kind=? ORDER BY place", (kind,))
        with contextlib.suppress(ValidationError):  # damaged: counts as empty
            return [record_adapter(outcome).validate_json(small) for (small,) in rows]
        return []

    def fingerprints(self, kind: str) -> dict[str, str]:
        """Return the fingerprint of each part of a kind, by name."""
        return dict(self._rows("SELECT name, fingerprint FROM part WHERE kind=?", (kind,)))

    def trace(self, kind: str, name: str) -> PageTrace | None:
        """Return the trace of a part; None if it has none."""
        query = "SELECT coarse, fine FROM part WHERE kind=? AND name=?"
        for coarse, fine in self._rows(query, (kind, name)):
            return PageTrace(coarse, fine) if coarse else None
        return None

    def state(self, kind: str, name: str) -> tuple[int, int] | None:
        """Return size and modification time [ns] of a part's data file when it was written."""
        query = "SELECT size, modified FROM part WHERE kind=? AND name=?"
        return next(self._rows(query, (kind, name)), None)

    def files(self) -> dict[str, Identity]:
        """Return the identity of every file that was read, by path."""
        rows = self._rows("SELECT path, size, modified, inode, sha256 FROM file", ())
        return {os.fsdecode(path): Identity(*facts) for path, *facts in rows}

    def fact(self, name: str) -> str:
        """Return a fact about the results as a whole; "" if unknown."""
        rows = self._rows("SELECT value FROM fact WHERE name=?", (name,))
        return next((str(value) for (value,) in rows), "")

    def close(self) -> None:
        """Close the catalogue."""
        if self._known is not None:
            self._known.close()
            self._known = None

    def _rows(self, query: str, values: tuple[str, ...]) -> Iterator[Any]:
        if self._known is not None:
            with contextlib.suppress(sqlite3.Error):  # damaged: counts as empty
                yield from self._known.execute(query, values)


class Identity(NamedTuple):
    """Identity of a file: size, modification time [ns], inode and checksum."""

    size: int
    modified: int
    inode: int
    sha256: str

    def is_of(self, state: os.stat_result) -> bool:
        """Whether a file is unchanged since it was read."""
        there = state.st_size, state.st_mtime_ns, state.st_ino
        return there == (self.size, self.modified, self.inode)


_SELECT = "SELECT name, fingerprint, record FROM part"


_ADAPTERS: dict[object, TypeAdapter[Any]] = {}


def record_adapter(record: type[Kept]) -> TypeAdapter[Kept]:
    """Return the serializer of a record type; cached, as making one is slow."""
    if record not in _ADAPTERS:
        _ADAPTERS[record] = TypeAdapter(record)
    return _ADAPTERS[record]


def _open_catalogue(folder: Path | None) -> sqlite3.Connection | None:
    """Open the catalogue of earlier results for reading."""
    if folder is None:
        return None
    with contextlib.suppress(sqlite3.Error, OSError):  # OSError: missing file, or a name too long
        (folder / CATALOGUE).stat()
        address = f"{(folder / CATALOGUE).resolve().as_uri()}?mode=ro&immutable=1"
        known = sqlite3.connect(address, uri=True, check_same_thread=False)
        if _has_our_format(known):
            return known
        known.close()
    return None


def _has_our_format(known: sqlite3.Connection) -> bool:
    with contextlib.suppress(sqlite3.Error):  # damaged
        return list(known.execute("SELECT value FROM fact WHERE name='format'")) == [(FORMAT,)]
    return False


def _inflated(packed: bytes) -> bytes:
    """Decompress a record; limited in size, so that a zip bomb gives invalid JSON."""
    return zlib.decompressobj().decompress(packed, MAX_RECORD)


def _entries(rows: Iterable[tuple[str, str, bytes]], record: type[Kept]) -> Iterator[Entry[Kept]]:
    for name, fingerprint, text in rows:
        try:
            yield Entry(name, fingerprint, record_adapter(record).validate_json(_inflated(text)))
        except (ValidationError, zlib.error, TypeError):  # damaged: counts as unknown
            continue
