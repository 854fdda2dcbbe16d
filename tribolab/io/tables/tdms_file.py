"""LabVIEW TDMS files, opened; a damaged one is an error that says so."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

from tribolab.errors import ReadError, brief

DAMAGE = (
    *(ValueError, KeyError, IndexError, TypeError, OSError, EOFError, struct.error),
    *(MemoryError, OverflowError, NotImplementedError, AttributeError),
)


def channel_names(path: Path) -> set[str]:
    """Names of the channels of a TDMS file as ``group/channel``.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    file = open_tdms(path, "read_metadata")
    return {f"{g.name}/{c.name}" for g in file.groups() for c in g.channels()}


def open_tdms(path: Path, how: str) -> Any:
    """Open a TDMS file by one of `nptdms.TdmsFile`'s ways: ``"read"``, ``"read_metadata"``.

    Raises
    ------
    ReadError
        If the file is damaged, or nptdms is not installed.
    """
    try:
        from nptdms import TdmsFile
    except ImportError as error:
        raise ReadError(
            f"{path}: TDMS files need the package nptdms: pip install 'tribolab[formats]'"
        ) from error
    try:
        return getattr(TdmsFile, how)(str(path))
    except DAMAGE as error:
        raise ReadError(
            f"{path}: the TDMS file is damaged: {brief(error)}; copy or save it again"
        ) from error
