"""Files of a folder or pattern by what they contain: runs, scans, moduli, roughness results."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.file_patterns import matching
from tribolab.reading.kinds import kind_of
from tribolab.reading.moduli import is_modulus_file
from tribolab.reading.unknown_run import is_run_file

_NO_DATA = (
    *(".toml", ".py", ".ipynb", ".md", ".rst", ".pdf", ".doc", ".docx", ".ppt", ".pptx", ".html"),
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".svg", ".gif", ".mp4", ".avi", ".zip", ".sqlite"),
)


def may_hold_data(path: Path) -> bool:
    """Whether files with this suffix may contain measurements."""
    return path.suffix.lower() not in _NO_DATA


def content_of(path: Path, instrument: str | None = None) -> str:
    """Return "run", "scan", "modulus" or "results"; an unreadable file counts as a run.

    Raises
    ------
    ConfigError, ReadError
        If the file cannot be read as `instrument`.
    """
    try:
        kind = kind_of(path, instrument)
        if kind != "unknown":
            return kind
        if is_modulus_file(path):
            return "modulus"
        return "run" if is_run_file(path, by_name=False) else "scan"
    except TribolabError:
        if instrument is not None:
            raise
        return "run"  # reading it as a run says what is wrong


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
    kinds = {path: content_of(path) for path in named if may_hold_data(path)}
    files = [path for path, kind in kinds.items() if kind == content]
    if not files:
        counts = Counter(kinds.values())
        found = ", ".join(f"{count} x {kind}" for kind, count in counts.items()) or "no data"
        raise ReadError(
            f"{pattern}: none of the files is a {content} (found: {found})",
            cure="tl.read reads runs, tl.read_scans scans, tl.rubber.read_modulus moduli",
        )
    return files
