"""Catalogue of new results, in which unchanged earlier results are reused."""

from __future__ import annotations

import contextlib
import os
import sqlite3
import time
import zlib
from collections.abc import Container, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tribolab.campaign.store.catalogue import (
    CATALOGUE,
    FORMAT,
    MAX_RECORD,
    Catalogue,
    Identity,
    Kept,
    record_adapter,
)
from tribolab.campaign.store.data_files import link
from tribolab.core.errors import OutputError
from tribolab.core.provenance import sha256_of_file
from tribolab.records.parts import PageTrace, Source
from tribolab.records.runs.run_record import RunRecord

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
        plain = record_adapter(type(record)).dump_json(record)
        if len(plain) > MAX_RECORD:
            raise OutputError(
                f"{kind} {name}: its record of {len(plain) >> 20} MB exceeds the limit of "
                f"{MAX_RECORD >> 20} MB",
                cure="for fewer segments, state stroke_middle in [segments] or "
                "limits.segments.min_duration in [qc], or split the file",
            )
        text = zlib.compress(plain, 3)
        coarse, fine = (trace.coarse, trace.fine) if trace else ("", "")
        outcome = getattr(record, "outcome", None)
        small = "" if outcome is None else record_adapter(type(outcome)).dump_json(outcome).decode()
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
            same = state.st_size == known[0]  # the marker has verified it; a copy has a new time
        else:
            same = (state.st_size, state.st_mtime_ns) == known
        same &= (
            state.st_mtime_ns <= time.time_ns()
        )  # not from the future: a later write could leave the same time
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
        self.say("format", FORMAT)
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
