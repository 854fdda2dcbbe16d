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
import time
import weakref
import zlib
from collections.abc import Container, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

from pydantic import TypeAdapter, ValidationError

from tribolab.campaign.store.data_files import link
from tribolab.core.errors import OutputError
from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.records.parts import PageTrace, Source
from tribolab.records.runs.run_record import RunRecord

CATALOGUE = "catalogue.sqlite"
_FORMAT = "1"
_MAX_RECORD = 1 << 28  # bytes: a run of 10 000 cycles has 20 MB
_LATE = 2_000_000_000  # ns; a file changed within this time of reading may change again unnoticed
_TABLES = """
CREATE TABLE part (
  kind TEXT, name TEXT, place INTEGER, fingerprint TEXT, outcome TEXT, record BLOB,
  coarse TEXT, fine TEXT, size INTEGER, modified INTEGER, PRIMARY KEY (kind, name)
);
CREATE TABLE file (path BLOB PRIMARY KEY, size INTEGER, modified INTEGER, inode INTEGER,
  sha256 TEXT);
CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT);
"""
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
        """Return a part; None if it is unknown."""
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
            return [_adapter(outcome).validate_json(small) for (small,) in rows]
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


class Store(Catalogue):
    """Catalogue being written, with access to the previous one.

    Parameters
    ----------
    folder
        Folder of the results being written.
    previous
        Folder of earlier results, if any.
    verify
        Whether to read every file again and compare checksums.
    intact
        Unchanged files of the earlier results; only these are reused. By default all are trusted.

    Attributes
    ----------
    before
        Catalogue of the earlier results.
    """

    def __init__(
        self,
        folder: Path,
        previous: Path | None = None,
        *,
        verify: bool = False,
        intact: Container[str] | None = None,
    ) -> None:
        self.folder = folder
        self.previous = previous if intact is None or CATALOGUE in intact else None
        self._intact = intact
        self.before = Catalogue.of(self.previous)
        self._files = {} if verify else self.before.files()
        self._seen: dict[str, Identity] = {}
        path = folder / CATALOGUE
        path.unlink(missing_ok=True)
        self._new = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        # no protection against crashes is needed: the folder appears only when all is written
        self._new.executescript(f"PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; {_TABLES}")
        self._new.execute("BEGIN")
        super().__init__(self._new)

    def put(
        self,
        kind: str,
        name: str,
        place: int,
        fingerprint: str,
        record: object,
        trace: PageTrace | None = None,
    ) -> None:
        """Store a part; replace one of the same name.

        Raises
        ------
        OutputError
            If the record is larger than one that is read back.
        """
        plain = _adapter(type(record)).dump_json(record)
        if len(plain) > _MAX_RECORD:
            raise OutputError(
                f"{kind} {name}: its record of {len(plain) >> 20} MB exceeds the limit of "
                f"{_MAX_RECORD >> 20} MB",
                cure="for fewer segments, state stroke_middle in [segments] or "
                "limits.segments.min_duration in [qc], or split the file",
            )
        text = zlib.compress(plain, 3)
        coarse, fine = (trace.coarse, trace.fine) if trace else ("", "")
        outcome = getattr(record, "outcome", None)
        small = "" if outcome is None else _adapter(type(outcome)).dump_json(outcome).decode()
        file = getattr(outcome, "data_file", "") or getattr(record, "file", "")
        _, size, modified = self.identity(file) if file else ("", 0, 0)
        row = (kind, name, place, fingerprint, small, text, coarse, fine, size, modified)
        self._new.execute("INSERT OR REPLACE INTO part VALUES (?,?,?,?,?,?,?,?,?,?)", row)

    def same(self, kind: str, name: str, fingerprint: str, record: type[Kept]) -> Kept | None:
        """Return an earlier part with the same fingerprint; None if there is none."""
        entry = self.before.get(kind, name, record)
        return entry.record if entry and entry.fingerprint == fingerprint else None

    def take(
        self, kind: str, earlier: str, place: int, fingerprint: str, record: RunRecord, file: str
    ) -> bool:
        """Reuse an earlier run with its data file and its trace.

        Parameters
        ----------
        kind, earlier, file
            Kind, name and data file of the earlier part.
        place, fingerprint, record
            New entry; the record contains the names of run and data file.

        Returns
        -------
        bool
            False if the data file was changed: then nothing is reused.
        """
        outcome = record.outcome
        if not self.link(kind, earlier, file, outcome.data_file):
            return False
        trace = self.before.trace(kind, earlier)
        self.put(kind, outcome.name, place, fingerprint, record, trace)
        return True

    def link(self, kind: str, name: str, old: str, new: str) -> bool:
        """Link the data file of an earlier part into the new results.

        Returns
        -------
        bool
            False if it is missing or was changed: then the part is computed again.
        """
        return self.intact(kind, name, old) is not None and self.link_file(old, new)

    def intact(self, kind: str, name: str, file: str) -> Path | None:
        """Return the data file of an earlier part; None if it is missing or was changed."""
        if self.previous is None or (self._intact is not None and file not in self._intact):
            return None
        try:
            state = (self.previous / file).stat()
        except OSError:  # missing
            return None
        known = self.before.state(kind, name)
        if self._intact is not None and known is not None:
            same = (
                state.st_size == known[0]
            )  # its checksum is known to agree; copies have new times
        else:
            same = (state.st_size, state.st_mtime_ns) == known
        same &= state.st_mtime_ns <= time.time_ns()  # a later one could pass for a new file
        return self.previous / file if same else None

    def link_file(self, old: str, new: str = "") -> bool:
        """Link a file of the earlier results into the new ones; False if it is not intact."""
        if self.previous is None or (self._intact is not None and old not in self._intact):
            return False
        try:
            (self.folder / (new or old)).parent.mkdir(parents=True, exist_ok=True)
            link(self.previous / old, self.folder / (new or old))
        except OSError:  # missing, or just replaced by another process
            return False
        return True

    def identity(self, file: str) -> tuple[str, int, int]:
        """Return name, size and modification time of a new file; reused files keep them."""
        state = (self.folder / file).stat()
        return file, state.st_size, state.st_mtime_ns

    def order(self, kind: str, names: Sequence[str]) -> None:
        """Set the order of the parts of a kind, and delete those not named."""
        there = self._new.execute("SELECT name FROM part WHERE kind=?", (kind,)).fetchall()
        gone = {name for (name,) in there} - set(names)
        self._new.executemany(
            "DELETE FROM part WHERE kind=? AND name=?", [(kind, name) for name in gone]
        )
        places = [(place, kind, name) for place, name in enumerate(names)]
        self._new.executemany("UPDATE part SET place=? WHERE kind=? AND name=?", places)

    def sources(self, files: Iterable[tuple[Path, str]]) -> tuple[Source, ...]:
        """Return label, checksum and size of files; unreadable ones have no checksum.

        Files that are known by size, time and inode are not read.
        """
        files = list(files)
        if len(files) < 2:
            return tuple(self._source(path, label) for path, label in files)
        with ThreadPoolExecutor(4) as threads:  # hashing releases the interpreter's lock
            return tuple(threads.map(lambda pair: self._source(*pair), files))

    def note_sources(self, files: Iterable[tuple[Path, Source]], began: int) -> None:
        """Note the identity of files that were read since `began` [ns], with their checksums."""
        for path, (_, checksum, size) in files:
            with contextlib.suppress(OSError):
                if checksum and (state := path.stat()).st_size == size:
                    self._note(path, state, checksum, began)

    def say(self, name: str, value: str) -> None:
        """Store a fact about the results as a whole."""
        self._new.execute("INSERT OR REPLACE INTO fact VALUES (?,?)", (name, value))

    def save(self) -> None:
        """Commit everything, so that others can read it; more may be written later."""
        # a path may contain bytes that SQLite text cannot
        rows = [(os.fsencode(path), *identity) for path, identity in self._seen.items()]
        self._new.executemany("INSERT OR REPLACE INTO file VALUES (?,?,?,?,?)", rows)
        self.say("format", _FORMAT)
        self._new.execute("COMMIT")
        self._new.execute("BEGIN")

    def close(self) -> None:
        """Commit everything and close the catalogue."""
        self.save()
        self._new.execute("COMMIT")
        super().close()
        self.before.close()

    def _source(self, path: Path, label: str) -> Source:
        try:
            state = path.stat()
            before = self._seen.get(str(path)) or self._files.get(str(path))
            if before and before.is_of(state):
                self._seen[str(path)] = before
                return label, before.sha256, state.st_size
            began = time.time_ns()
            checksum = sha256_of_file(path)
        except OSError:  # missing or unreadable: the outcome of its part reports it
            return label, "", 0
        self._note(path, state, checksum, began)
        return label, checksum, state.st_size

    def _note(self, path: Path, state: os.stat_result, checksum: str, began: int) -> None:
        """Note a file, unless it changed so recently that it may change again unnoticed."""
        if state.st_mtime_ns < began - _LATE:
            facts = (state.st_size, state.st_mtime_ns, state.st_ino, checksum)
            self._seen[str(path)] = Identity(*facts)


_SELECT = "SELECT name, fingerprint, record FROM part"


_ADAPTERS: dict[object, TypeAdapter[Any]] = {}


def _adapter(record: type[Kept]) -> TypeAdapter[Kept]:
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
        return list(known.execute("SELECT value FROM fact WHERE name='format'")) == [(_FORMAT,)]
    return False


def _inflated(packed: bytes) -> bytes:
    """Decompress a record; limited in size, so that a zip bomb gives invalid JSON."""
    return zlib.decompressobj().decompress(packed, _MAX_RECORD)


def _entries(rows: Iterable[tuple[str, str, bytes]], record: type[Kept]) -> Iterator[Entry[Kept]]:
    for name, fingerprint, text in rows:
        try:
            yield Entry(name, fingerprint, _adapter(record).validate_json(_inflated(text)))
        except (ValidationError, zlib.error, TypeError):  # damaged: counts as unknown
            continue
