"""The seal of what tribolab writes: a checksum, by which damage is noticed when a file is read.

`seal` puts the SHA-256 of a file behind its last byte, where HDF5 does not look; `check_seal`
refuses a file that is not what it was. The seal has no key: it detects damage, not forgery.
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
    """Put a file's SHA-256 behind its end."""
    with path.open("r+b") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.seek(0, os.SEEK_END)
        file.write(_MARK + digest.encode())


def unseal(path: Path) -> None:
    """Take the seal off, before the file is changed."""
    with path.open("r+b") as file:
        size = file.seek(0, os.SEEK_END)
        if size > _LENGTH:
            file.seek(size - _LENGTH)
            if file.read(len(_MARK)) == _MARK:
                file.truncate(size - _LENGTH)


def carries_seal(path: Path) -> bool:
    """Whether a file ends in a seal, as what tribolab writes."""
    with path.open("rb") as file:
        return bool(_mark_of(file)[1])


def _mark_of(file: BinaryIO) -> tuple[int, bytes]:
    """Return the size of what is sealed, and the seal; b"" if there is none."""
    left = file.seek(0, os.SEEK_END) - _LENGTH
    if left < 0:
        return 0, b""
    file.seek(left)
    mark = file.read()
    return (left, mark) if mark.startswith(_MARK) else (0, b"")


def check_seal(path: Path) -> None:
    """Refuse a file that carries a seal and is not what it was when it was sealed.

    A file without a seal, as other programs write it, passes.

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
