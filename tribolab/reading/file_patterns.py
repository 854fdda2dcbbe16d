"""Search for files whose names match a pattern with wildcards."""

from __future__ import annotations

import glob
from pathlib import Path

from tribolab.core.errors import ReadError


def is_pattern(path: str | Path) -> bool:
    """Return whether a path has wildcards and is not itself the name of a file.

    Examples
    --------
    >>> is_pattern("raw/*.csv"), is_pattern("raw/one.csv")
    (True, False)
    """
    name = str(path)
    return glob.has_magic(name) and "\0" not in name and not Path(path).exists()


def matching(pattern: str | Path) -> list[Path]:
    """Return the paths that match a pattern, in order of name.

    Raises
    ------
    ReadError
        If there is no match.
    """
    path = Path(pattern)
    folder = next(parent for parent in path.parents if parent.is_dir())  # even "a*b"
    names = folder.glob(str(path.relative_to(folder)))
    files = sorted(name for name in names if not name.name.startswith("."))
    if not files:
        raise ReadError(f"{pattern}: {why_missing(path)}")
    return files


def why_missing(path: Path) -> str:
    """Return in words why a path does not exist: no file, no folder, or no match."""
    if any(sign in str(path.parent) for sign in "*?") and not path.parent.is_dir():
        return "the pattern matches nothing"
    if not path.parent.is_dir():
        return f"there is no folder {path.parent}"
    if any(sign in path.name for sign in "*?["):
        return f"the pattern matches nothing in {path.parent}"
    return "there is no such file"
