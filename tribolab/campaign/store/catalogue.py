"""The catalogue: what is known of every part of a campaign, and from what it was made.

A file of SQLite in the results folder, one row for each run, curve, surface, model and figure: what
it came to, small; everything that is shown of it, as compressed JSON of a typed record; the trace
that the page draws. Tables, page, report.json and the next run are made from it, without opening
a data file. Beside them the identity of every file that was read, so that what did not change is
recognised by size, time and inode, without reading it again.
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
from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.records.parts import PageTrace, Source
from tribolab.records.runs.run_record import RunRecord

CATALOGUE = "catalogue.sqlite"
_FORMAT = "1"
_LARGEST_RECORD = 1 << 24  # bytes: records of long runs have some 100 kB
_LATE = 2_000_000_000  # ns before it was read, within which a change says nothing of later ones
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
    """Return the checksum of all that shapes a part, but of its files: settings and version."""
    # late: looks the installed package up
    from tribolab.version import __version__

    return sha256_of([__version__, config_sha256])


class Entry(NamedTuple, Generic[Kept]):
    """A part as it is known: from what, what it came to, and all that is shown of it."""

    name: str
    fingerprint: str
    record: Kept


class Catalogue:
    """What is known of the parts of a results folder, for reading.

    Parameters
    ----------
    known
        An open catalogue; None knows nothing.
    """

    def __init__(self, known: sqlite3.Connection | None) -> None:
        self._known = known
        if known is not None:  # whoever forgets the catalogue closes it
            weakref.finalize(self, known.close)

    @classmethod
    def of(cls, folder: Path | None) -> Catalogue:
        """Open the catalogue of a results folder.

        A folder without one, or with one that is damaged or of another format, knows nothing.
        """
        return Catalogue(_opened(folder))

    def get(self, kind: str, name: str, record: type[Kept]) -> Entry[Kept] | None:
        """Return a part; None if there is none."""
        rows = self._rows(f"{_SELECT} WHERE kind=? AND name=?", (kind, name))
        return next(_entries(rows, record), None)

    def all(self, kind: str, record: type[Kept]) -> Iterator[Entry[Kept]]:
        """Return all parts of a kind, in their order; one after the other, none is held."""
        rows = self._rows(f"{_SELECT} WHERE kind=? ORDER BY place", (kind,))
        return _entries(rows, record)

    def outcomes(self, kind: str, outcome: type[Kept]) -> list[Kept]:
        """Return what the parts of a kind came to, in their order."""
        rows = self._rows("SELECT outcome FROM part WHERE kind=? ORDER BY place", (kind,))
        with contextlib.suppress(ValidationError):  # damaged: not known
            return [_adapter(outcome).validate_json(small) for (small,) in rows]
        return []

    def trace(self, kind: str, name: str) -> PageTrace | None:
        """Return the trace of a part; None if it has none."""
        query = "SELECT coarse, fine FROM part WHERE kind=? AND name=?"
        for coarse, fine in self._rows(query, (kind, name)):
            return PageTrace(coarse, fine) if coarse else None
        return None

    def state(self, kind: str, name: str) -> tuple[int, int] | None:
        """Return size and time of change [ns] of a part's data file as it was written."""
        query = "SELECT size, modified FROM part WHERE kind=? AND name=?"
        return next(self._rows(query, (kind, name)), None)

    def files(self) -> dict[str, Identity]:
        """Return the identity of every file that was read."""
        rows = self._rows("SELECT path, size, modified, inode, sha256 FROM file", ())
        return {os.fsdecode(path): Identity(*facts) for path, *facts in rows}

    def fact(self, name: str) -> str:
        """Return a fact about the results as a whole; "" if it is not known."""
        rows = self._rows("SELECT value FROM fact WHERE name=?", (name,))
        return next((str(value) for (value,) in rows), "")

    def close(self) -> None:
        """Read no more."""
        if self._known is not None:
            self._known.close()
            self._known = None

    def _rows(self, query: str, values: tuple[str, ...]) -> Iterator[Any]:
        if self._known is not None:
            with contextlib.suppress(sqlite3.Error):  # damaged: nothing is known
                yield from self._known.execute(query, values)


class Identity(NamedTuple):
    """How a file is known again: size, time of change [ns], inode; and its checksum."""

    size: int
    modified: int
    inode: int
    sha256: str

    def is_of(self, state: os.stat_result) -> bool:
        """Whether a file is still the one that was read."""
        there = state.st_size, state.st_mtime_ns, state.st_ino
        return there == (self.size, self.modified, self.inode)


class Store(Catalogue):
    """The catalogue that is being written, and that of the results before.

    Parameters
    ----------
    folder
        Of the results that are being written.
    previous
        Folder of earlier results, if there is one.
    verify
        Whether files are recognised by their checksums only, each read anew.
    intact
        Which files of the earlier results are as they were written; no others are taken over. By
        default all are trusted.

    Attributes
    ----------
    before
        What is known of the earlier results.
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
        # the folder appears as a whole when all is written, so nothing has to outlive a crash
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
        """Write down a part; a part of that name is replaced."""
        text = zlib.compress(_adapter(type(record)).dump_json(record), 3)
        coarse, fine = (trace.coarse, trace.fine) if trace else ("", "")
        outcome = getattr(record, "outcome", None)
        small = "" if outcome is None else _adapter(type(outcome)).dump_json(outcome).decode()
        file = getattr(outcome, "data_file", "") or getattr(record, "file", "")
        _, size, modified = self.identity(file) if file else ("", 0, 0)
        row = (kind, name, place, fingerprint, small, text, coarse, fine, size, modified)
        self._new.execute("INSERT OR REPLACE INTO part VALUES (?,?,?,?,?,?,?,?,?,?)", row)

    def same(self, kind: str, name: str, fingerprint: str, record: type[Kept]) -> Kept | None:
        """Return an earlier part that is made of the same; None if there is none."""
        entry = self.before.get(kind, name, record)
        return entry.record if entry and entry.fingerprint == fingerprint else None

    def take(
        self, kind: str, earlier: str, place: int, fingerprint: str, record: RunRecord, file: str
    ) -> bool:
        """Take over an earlier run with its data file and its trace.

        Parameters
        ----------
        kind, earlier, file
            Where it stood.
        place, fingerprint, record
            How it is written down now; the record says how run and data file are called.

        Returns
        -------
        bool
            False if the data file is not as it was written: then nothing is taken over.
        """
        outcome = record.outcome
        if not self.link(kind, earlier, file, outcome.data_file):
            return False
        trace = self.before.trace(kind, earlier)
        self.put(kind, outcome.name, place, fingerprint, record, trace)
        return True

    def link(self, kind: str, name: str, old: str, new: str) -> bool:
        """Have the data file of an earlier part among the new ones.

        Returns
        -------
        bool
            False if it is not there, or not as it was written: then the part is done anew.
        """
        return self.intact(kind, name, old) is not None and self.link_beside(old, new)

    def intact(self, kind: str, name: str, file: str) -> Path | None:
        """Return the data file of an earlier part; None if it is not there as it was written."""
        if self.previous is None or (self._intact is not None and file not in self._intact):
            return None
        try:
            state = (self.previous / file).stat()
        except OSError:  # gone
            return None
        same = (state.st_size, state.st_mtime_ns) == self.before.state(kind, name)
        return self.previous / file if same else None

    def link_beside(self, old: str, new: str = "") -> bool:
        """Have a file of the earlier results among the new ones; False if it is not intact."""
        if self.previous is None or (self._intact is not None and old not in self._intact):
            return False
        try:
            (self.folder / (new or old)).parent.mkdir(parents=True, exist_ok=True)
            link(self.previous / old, self.folder / (new or old))
        except OSError:  # gone, or replaced by another process meanwhile
            return False
        return True

    def identity(self, file: str) -> tuple[str, int, int]:
        """Return name, size and time of change of a new file: what is taken over keeps them."""
        state = (self.folder / file).stat()
        return file, state.st_size, state.st_mtime_ns

    def order(self, kind: str, names: Sequence[str]) -> None:
        """Give the parts of a kind their order; those that are not named are taken out."""
        there = self._new.execute("SELECT name FROM part WHERE kind=?", (kind,)).fetchall()
        gone = {name for (name,) in there} - set(names)
        self._new.executemany(
            "DELETE FROM part WHERE kind=? AND name=?", [(kind, name) for name in gone]
        )
        places = [(place, kind, name) for place, name in enumerate(names)]
        self._new.executemany("UPDATE part SET place=? WHERE kind=? AND name=?", places)

    def sources(self, files: Iterable[tuple[Path, str]]) -> tuple[Source, ...]:
        """Return label, checksum and size of files; no checksum of what cannot be read.

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
        """Write down a fact about the results as a whole."""
        self._new.execute("INSERT OR REPLACE INTO fact VALUES (?,?)", (name, value))

    def save(self) -> None:
        """Write everything to the disk, so that others may read it; more may be written then."""
        # a name may have any bytes, which a text of SQLite may not
        rows = [(os.fsencode(path), *identity) for path, identity in self._seen.items()]
        self._new.executemany("INSERT OR REPLACE INTO file VALUES (?,?,?,?,?)", rows)
        self.say("format", _FORMAT)
        self._new.execute("COMMIT")
        self._new.execute("BEGIN")

    def close(self) -> None:
        """Write everything to the disk, and nothing more."""
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
        except OSError:  # vanished or unreadable: the outcome of its part says so
            return label, "", 0
        self._note(path, state, checksum, began)
        return label, checksum, state.st_size

    def _note(self, path: Path, state: os.stat_result, checksum: str, began: int) -> None:
        """Note a file, unless it was changed so shortly before that it may have changed since."""
        if state.st_mtime_ns < began - _LATE:
            facts = (state.st_size, state.st_mtime_ns, state.st_ino, checksum)
            self._seen[str(path)] = Identity(*facts)


_SELECT = "SELECT name, fingerprint, record FROM part"


_ADAPTERS: dict[object, TypeAdapter[Any]] = {}


def _adapter(record: type[Kept]) -> TypeAdapter[Kept]:
    """Return what reads and writes a record; to make one takes a while, so each is made once."""
    if record not in _ADAPTERS:
        _ADAPTERS[record] = TypeAdapter(record)
    return _ADAPTERS[record]


def _opened(folder: Path | None) -> sqlite3.Connection | None:
    """Open the catalogue of earlier results for reading."""
    if folder is None:
        return None
    with contextlib.suppress(sqlite3.Error, OSError):  # OSError: none is there, or a name too long
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
    """Unpack a record; of a bomb only its beginning, which is no JSON."""
    return zlib.decompressobj().decompress(packed, _LARGEST_RECORD)


def _entries(rows: Iterable[tuple[str, str, bytes]], record: type[Kept]) -> Iterator[Entry[Kept]]:
    for name, fingerprint, text in rows:
        try:
            yield Entry(name, fingerprint, _adapter(record).validate_json(_inflated(text)))
        except (ValidationError, zlib.error, TypeError):  # damaged: not known
            continue
