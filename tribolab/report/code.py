"""Checksums of the code that makes a report; if the code changes, the report is written again."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.version import __version__

_PACKAGE = Path(__file__).resolve().parents[1]
_ROOMS = ("report", "figures", "records")
_PYTHON = (".py",)
_WHOLE = (*_PYTHON, ".j2", ".js", ".css", ".LICENSE")


@cache
def code_of_figures() -> str:
    """Return a checksum of the package version and the code that draws figures."""
    return _checksum(_PYTHON)


@cache
def code_of_page() -> str:
    """Return a checksum of the package version and the code, templates and scripts of reports."""
    return _checksum(_WHOLE)


def _checksum(kinds: tuple[str, ...]) -> str:
    """Return a checksum of files with given suffixes, independent of the installation path."""
    files = (file for room in _ROOMS for file in (_PACKAGE / room).rglob("*"))
    chosen = sorted((str(f.relative_to(_PACKAGE)), f) for f in files if f.suffix in kinds)
    return sha256_of([__version__, [[name, sha256_of_file(file)] for name, file in chosen]])
