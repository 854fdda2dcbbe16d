"""Which files of a results folder are ours: those that its marker lists and that are unchanged."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

MARKER = ".tribolab-results"
_ABOUT = (
    "Written by tribolab. The files listed here are replaced by the next run as a whole; whatever "
    "else lies in this folder is left where it is."
)


class LedgerEntry(NamedTuple):
    """A file as it was written: size [bytes], time of its last change [ns], BLAKE2b of it."""

    size: int
    modified: int
    digest: str


@dataclass(frozen=True)
class Ledger:
    """The files that one run wrote, by their path in the results folder.

    Parameters
    ----------
    folder
        The results folder.
    files
        Entries by path relative to the folder, with "/" between its parts.
    folders
        Folders that the run made and left empty, e.g. that of the data when every run failed.
    """

    folder: Path
    files: dict[str, LedgerEntry] = field(default_factory=dict)
    folders: frozenset[str] = frozenset()

    @classmethod
    def read(cls, folder: Path) -> Ledger:
        """Read the marker of a folder; one that is missing or damaged lists nothing."""
        try:
            listed = json.loads((folder / MARKER).read_text(encoding="utf-8"))
            files = {str(name): LedgerEntry(*entry) for name, entry in listed["files"].items()}
            folders = frozenset(map(str, listed.get("folders", ())))
        except (OSError, ValueError, LookupError, TypeError, AttributeError):
            return cls(folder)
        return cls(folder, files, folders)

    def is_ours(self, name: str) -> bool:
        """Whether a file is the one that was written: a copied marker makes nothing ours."""
        entry, path = self.files.get(name), self.folder / name
        if entry is None or path.is_symlink() or not path.is_file():
            return False
        state = path.stat()
        if state.st_size != entry.size:
            return False
        return state.st_mtime_ns == entry.modified or _digest(path) == entry.digest

    @property
    def is_whole(self) -> bool:
        """Whether everything that was written is there, by size."""
        try:
            return bool(self.files) and all(
                (self.folder / name).stat().st_size == entry.size
                for name, entry in self.files.items()
            )
        except OSError:
            return False

    def foreign(self) -> list[str]:
        """Return the paths of all files that are not ours, in the folder's order of names.

        Symbolic links are files here, wherever they lead; folders count if they are empty and the
        marker knows no file in them.
        """
        folders = self.folders | {str(Path(name).parent) for name in self.files}
        names = []
        for name in walk(self.folder):
            path = self.folder / name
            if name == MARKER or (path.is_dir() and not path.is_symlink() and name in folders):
                continue
            if not self.is_ours(name):
                names.append(name)
        return names

    def write(self, folder: Path) -> None:
        """List everything in a new folder as ours; what was taken over is not read again."""
        files, folders = {}, []
        for name in walk(folder):
            path = folder / name
            if path.is_dir() and not path.is_symlink():
                folders.append(name)
            if path.is_symlink() or not path.is_file():
                continue
            state, before = path.stat(), self.files.get(name)
            same = before and (before.size, before.modified) == (state.st_size, state.st_mtime_ns)
            digest = before.digest if before and same else _digest(path)
            files[name] = LedgerEntry(state.st_size, state.st_mtime_ns, digest)
        listed = {"about": _ABOUT, "files": files, "folders": folders}
        text = json.dumps(listed, indent=0, ensure_ascii=True)
        (folder / MARKER).write_text(text + "\n", encoding="utf-8")


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
    """Return the name under which a file of ours is kept that somebody has changed.

    Examples
    --------
    >>> other_name("tables/friction.csv", 1_790_000_000_000_000_000)
    'tables/friction.changed-20260921T141320.csv'
    """
    path = Path(name)
    when = dt.datetime.fromtimestamp(modified / 1e9, dt.UTC).strftime("%Y%m%dT%H%M%S")
    return path.with_name(f"{path.stem}.changed-{when}{path.suffix}").as_posix()


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "blake2b").hexdigest()[:32]
