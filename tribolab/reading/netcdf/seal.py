"""Seal of files written by tribolab: a checksum that reveals damage on reading.

`seal` appends the SHA-256 of a file to its end, which HDF5 does not read; `check_seal` refuses a
file whose content does not match it. The seal has no key: it detects damage, not forgery.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import BinaryIO

from tribolab.core.errors import ReadError

_MARK = b"\ntribolab sha256 "
_LENGTH = len(_MARK) + 64


def seal(path: Path) -> None:
    """Append a file's SHA-256 to it."""
    with path.open("r+b") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.seek(0, os.SEEK_END)
        file.write(_MARK + digest.encode())


def unseal(path: Path) -> None:
    """Remove the seal before the file is changed."""
    with path.open("r+b") as file:
        left, mark = _mark_of(file)
        if mark:
            file.truncate(left)


def carries_seal(path: Path) -> bool:
    """Whether a file ends with a seal."""
    with path.open("rb") as file:
        return bool(_mark_of(file)[1])


def _mark_of(file: BinaryIO) -> tuple[int, bytes]:
    """Return the size of the sealed content, and the seal; b"" without one."""
    left = file.seek(0, os.SEEK_END) - _LENGTH
    if left < 0:
        return 0, b""
    file.seek(left)
    mark = file.read()
    return (left, mark) if mark.startswith(_MARK) else (0, b"")


def check_seal(path: Path) -> None:
    """Raise if a file does not match its seal.

    Files without a seal, e.g. of other programs, are accepted.

    Raises
    ------
    ReadError
        If its bytes changed.
    """
    with path.open("rb") as file:
        left, mark = _mark_of(file)
        if not mark:
            return
        file.seek(0)
        digest = hashlib.sha256()
        while left > 0 and (block := file.read(min(left, 1 << 20))):
            digest.update(block)
            left -= len(block)
    if mark != _MARK + digest.hexdigest().encode():
        raise ReadError(
            "the file is damaged: its checksum does not match its content; copy or write it again",
            where=path,
        )
