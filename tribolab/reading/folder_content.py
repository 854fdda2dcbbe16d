"""Content of the files in a folder or pattern: runs, scans, moduli, roughness results."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.file_patterns import matching
from tribolab.reading.kinds import kind_of
from tribolab.reading.moduli import is_modulus_file
from tribolab.reading.text.first_bytes import peek
from tribolab.reading.unknown_run import draft_of, is_run_file

_NO_DATA = (
    *(".toml", ".py", ".ipynb", ".md", ".rst", ".pdf", ".doc", ".docx", ".ppt", ".pptx", ".html"),
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".svg", ".gif", ".mp4", ".avi", ".zip", ".sqlite"),
)


def may_hold_data(path: Path) -> bool:
    """Whether a file may contain measurements, by its suffix."""
    return path.suffix.lower() not in _NO_DATA


def contents_of(paths: Iterable[Path], instrument: str | None = None) -> dict[Path, str]:
    """Return what each file contains: "run", "scan", "modulus" or "results".

    An unreadable file counts as a run. A text without a table of numbers, such as a log that broke
    off, gets the usual content of the files whose names differ from its own only in numbers.

    Raises
    ------
    ConfigError, ReadError
        If a file cannot be read as `instrument`.
    """
    found = {path: _content_of(path, instrument) for path in paths}
    siblings: dict[str, Counter[str]] = {}
    for path, content in found.items():
        siblings.setdefault(_without_numbers(path), Counter()).update([content] if content else [])
    for path in (path for path, content in found.items() if not content):
        [*usual] = siblings[_without_numbers(path)].most_common(1)
        found[path] = usual[0][0] if usual else "scan"
    return found


def _without_numbers(path: Path) -> str:
    return re.sub(r"\d+", "#", path.name)


def _content_of(path: Path, instrument: str | None) -> str:
    """Return what a file contains; "" for a text without a table of numbers."""
    try:
        kind = kind_of(path, instrument)
        if kind != "unknown":
            return kind
        if is_modulus_file(path):
            return "modulus"
        if is_run_file(path, by_name=False):
            return "run"
        bare = peek(path).format == "text" and draft_of(path) is None
        return "" if bare else "scan"
    except TribolabError:
        if instrument is not None:
            raise
        return "run"  # reading the file as a run reports the error


def files_with(content: str, pattern: str | Path) -> list[Path]:
    """Return the files of a folder or pattern that contain a "run", or a "scan".

    Raises
    ------
    ReadError
        If there is none; the message says what the files contain.
    """
    folder = Path(pattern).is_dir()
    named = [path for path in matching(Path(pattern, "*") if folder else pattern) if path.is_file()]
    if not named:
        raise ReadError(f"{pattern}: only folders have such a name; write e.g. '{pattern}/*.csv'")
    kinds = contents_of(path for path in named if may_hold_data(path))
    files = [path for path, kind in kinds.items() if kind == content]
    if not files:
        counts = Counter(kinds.values())
        found = ", ".join(f"{count} x {kind}" for kind, count in counts.items()) or "no data"
        raise ReadError(
            f"{pattern}: none of the files is a {content} (found: {found})",
            cure="tl.read reads runs, tl.read_scans scans, tl.rubber.read_modulus moduli",
        )
    return files
