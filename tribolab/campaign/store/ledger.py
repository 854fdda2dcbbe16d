"""Ledger of a results folder: files that tribolab wrote, and whether they are unchanged."""

from __future__ import annotations

import contextlib
import datetime as dt
import hashlib
import json
import os
import re
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tribolab.campaign.store.limits import ALWAYS_READ, SAMPLE, SAMPLES

MARKER = ".tribolab-results"
_LENGTH = 32  # digits of a checksum
# compared with each marker: another text would make the markers of earlier versions invalid
_ABOUT = (
    "Written by tribolab. The files listed here are replaced by the next run as a whole; whatever "
    "else lies in this folder is left where it is."
)


class LedgerEntry(NamedTuple):
    """State of a file when it was written.

    Attributes
    ----------
    size, modified, inode
        Size [bytes], modification time [ns] and inode; 0 if unknown (earlier versions).
    digest, sample
        BLAKE2b of all bytes, and of samples of them; "" if the file is small or it is unknown.
    """

    size: int
    modified: int
    digest: str
    inode: int = 0
    sample: str = ""

    @classmethod
    def of(cls, path: Path) -> LedgerEntry:
        """Return the entry of a file as it is now."""
        state = path.stat()
        sample = _sample(path) if state.st_size > ALWAYS_READ.value else ""
        return cls(state.st_size, state.st_mtime_ns, _digest(path), state.st_ino, sample)

    def is_of(self, path: Path, *, whole: bool = False) -> bool:
        """Whether a file is unchanged; with `whole` all bytes of a large file are compared."""
        if path.is_symlink() or not path.is_file():
            return False
        state = path.stat()
        if state.st_size != self.size:
            return False
        if not whole and self.sample and self.is_state(state):
            return _sample(path) == self.sample
        return _digest(path) == self.digest

    def is_state(self, state: os.stat_result) -> bool:
        """Whether size, modification time and inode are unchanged."""
        there = (state.st_size, state.st_mtime_ns, state.st_ino)
        return there == (self.size, self.modified, self.inode)


@dataclass(frozen=True)
class Ledger:
    """Files that one run wrote, by path in the results folder.

    Parameters
    ----------
    folder
        The results folder.
    files
        Entries by path relative to the folder, with "/" between its parts.
    folders
        Folders that the run left empty, e.g. ``data`` if every run failed.
    sound
        Whether the marker is unchanged. From a damaged marker, only files whose checksum it still
        contains are listed.
    """

    folder: Path
    files: dict[str, LedgerEntry] = field(default_factory=dict)
    folders: frozenset[str] = frozenset()
    sound: bool = False

    @classmethod
    def read(cls, folder: Path) -> Ledger:
        """Read the marker of a folder; one that is missing or not a regular file lists no files."""
        try:
            text = (folder / MARKER).read_bytes() if (folder / MARKER).is_file() else b""
        except OSError:
            text = b""
        if not text:
            return cls(folder)
        with contextlib.suppress(
            *(ValueError, LookupError, TypeError, AttributeError, RecursionError)
        ):
            listed = json.loads(text)
            plain = "blake2b" not in listed  # written by an early version
            as_written = listed.get("about") == _ABOUT and text == _as_text(listed)
            whole = plain or (as_written and listed["blake2b"] == _checksum(listed))
            inside = all(map(_is_inside, listed["files"]))
            if whole and inside and set(listed) <= {"about", "blake2b", "files", "folders"}:
                files = {name: LedgerEntry(*entry) for name, entry in listed["files"].items()}
                return cls(folder, files, frozenset(listed.get("folders", ())), sound=True)
        known = {digest.decode() for digest in re.findall(rb"[0-9a-f]{32}", text)}
        found = {name: folder / name for name in walk(folder) if name != MARKER}
        entries = {n: LedgerEntry.of(p) for n, p in found.items() if p.is_file()}
        ours = {name: entry for name, entry in entries.items() if entry.digest in known}
        return cls(folder, ours)

    def is_ours(self, name: str, *, whole: bool = False) -> bool:
        """Whether a file is ours and unchanged; a copied marker does not make other files ours."""
        entry = self.files.get(name)
        return entry is not None and entry.is_of(self.folder / name, whole=whole)

    def intact(self, *, whole: bool = False) -> frozenset[str]:
        """Return the unchanged files.

        Parameters
        ----------
        whole
            Whether to compare all bytes of large files; by default size, modification time, inode
            and samples are compared.
        """
        there = set(walk(self.folder))  # a forged marker may list any number of files
        names = [name for name in self.files if name in there]
        with ThreadPoolExecutor(4) as threads:  # hashing releases the interpreter's lock
            good = list(threads.map(lambda name: self.is_ours(name, whole=whole), names))
        return frozenset(name for name, same in zip(names, good, strict=True) if same)

    def damaged(self, intact: frozenset[str]) -> tuple[str, ...]:
        """Return changed or missing files, the marker first; `intact` are the unchanged files."""
        marker = () if self.sound or not self.files else (MARKER,)
        return (*marker, *sorted(set(self.files) - intact))

    def problems(self) -> list[str]:
        """Return a message for each changed or missing file; all bytes are compared."""
        if not self.files and not self.sound:
            return [
                f"{MARKER}: lost, or damaged beyond use; 'tribolab verify --repair {self.folder}' "
                "writes it again"
            ]
        cure = "'tribolab run' computes it again from the raw files"
        wrong, there = [], set(walk(self.folder))
        for name in self.damaged(self.intact(whole=True)):
            if name in there:
                note = "" if name == MARKER else ", and keeps this version as well"
                wrong.append(f"{name}: not as it was written; {cure}{note}")
            else:
                wrong.append(f"{name}: missing; {cure}")
        return wrong

    def foreign(self, intact: frozenset[str] | None = None) -> list[str]:
        """Return the paths of all files that are not ours or were changed, sorted.

        Symbolic links count as files. Folders count if they are empty and the marker lists no file
        in them.
        """
        intact = self.intact() if intact is None else intact
        folders = self.folders | {os.path.dirname(name) for name in self.files}  # noqa: PTH120 - quick
        names = []
        for name in walk(self.folder):
            path = self.folder / name
            if name == MARKER or (path.is_dir() and not path.is_symlink() and name in folders):
                continue
            if name not in intact:
                names.append(name)
        return names

    def write(self, folder: Path) -> None:
        """List all files of a folder as ours; reused files are not read again."""
        files, folders = {}, []
        for name in walk(folder):
            path = folder / name
            if path.is_dir() and not path.is_symlink():
                folders.append(name)
            if name == MARKER or path.is_symlink() or not path.is_file():
                continue
            before = self.files.get(name)
            same = before is not None and before.is_state(path.stat())
            files[name] = before if before and same else LedgerEntry.of(path)
        _write(folder, files, folders)


def _write(folder: Path, files: Mapping[str, LedgerEntry], folders: Sequence[str]) -> None:
    listed: dict[str, object] = {"about": _ABOUT, "files": files, "folders": folders}
    listed["blake2b"] = _checksum(listed)
    (folder / MARKER).write_bytes(_as_text(listed))


def repair(folder: Path) -> None:
    """Write a lost marker again, so that the next run recomputes everything and loses nothing.

    Data, figures and report.json are listed as they are. A person may have changed tables and page:
    they and the catalogue count as changed, so the next run keeps them under other names.
    """
    files = {}
    for name in walk(folder):
        path, room = folder / name, name.split("/")[0]
        if path.is_symlink() or not path.is_file() or ".changed-" in name:
            continue
        if room in ("data", "figures") or name == "report.json":
            files[name] = LedgerEntry.of(path)
        elif room == "tables" or name in ("report.html", "catalogue.sqlite"):
            files[name] = LedgerEntry.of(path)._replace(digest="", sample="")
    _write(folder, files, [])


def walk(folder: Path) -> list[str]:
    """Return the relative paths of all files, links and empty folders below a folder, sorted."""
    names = []
    for place, folders, files in os.walk(folder):
        here = Path(place)
        links = [name for name in folders if (here / name).is_symlink()]
        names += [(here / name).relative_to(folder).as_posix() for name in (*files, *links)]
        if here != folder and not files and not folders:
            names.append(here.relative_to(folder).as_posix())
    return sorted(names)


def other_name(name: str, modified: int) -> str:
    """Return the new name of one of our files that somebody has changed.

    Examples
    --------
    >>> other_name("tables/friction.csv", 1_790_000_000_000_000_000)
    'tables/friction.changed-20260921T141320.csv'
    """
    path = Path(name)
    when = dt.datetime.fromtimestamp(modified / 1e9, dt.UTC).strftime("%Y%m%dT%H%M%S")
    return path.with_name(f"{path.stem}.changed-{when}{path.suffix}").as_posix()


def _as_text(listed: Mapping[str, object]) -> bytes:
    return json.dumps(listed, indent=0, ensure_ascii=True).encode() + b"\n"


def _checksum(listed: Mapping[str, object]) -> str:
    text = json.dumps([listed["files"], listed.get("folders", [])], sort_keys=True)
    return hashlib.blake2b(text.encode()).hexdigest()[:_LENGTH]


def _is_inside(name: str) -> bool:
    return not name.startswith("/") and ".." not in name.split("/")


def _sample(path: Path) -> str:
    """Return the checksum of evenly spaced samples of a file."""
    size, count, length = path.stat().st_size, int(SAMPLES.value), int(SAMPLE.value)
    checksum = hashlib.blake2b()
    with path.open("rb") as file:
        for k in range(count):
            file.seek(k * max(size - length, 0) // (count - 1))
            checksum.update(file.read(length))
    return checksum.hexdigest()[:_LENGTH]


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "blake2b").hexdigest()[:_LENGTH]
