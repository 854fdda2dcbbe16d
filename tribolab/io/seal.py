"""The seal of what tribolab writes: whether an HDF5 file is whole is told before it is opened.

`seal` puts the SHA-256 of a file behind its last byte, where HDF5 does not look; `is_sealed` finds
it whole. What is sealed is opened as fast as ever; the rest is tried out, see `tribolab.trials`.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

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


def is_sealed(path: Path) -> bool:
    """Whether a file carries a seal, and is what it was when it was sealed."""
    with path.open("rb") as file:
        left = file.seek(0, os.SEEK_END) - _LENGTH
        if left < 0:
            return False
        file.seek(left)
        magic = file.read()
        if not magic.startswith(_MARK):
            return False
        file.seek(0)
        digest = hashlib.sha256()
        while left > 0:
            block = file.read(min(left, 1 << 20))
            if not block:
                return False
            digest.update(block)
            left -= len(block)
    return magic == _MARK + digest.hexdigest().encode()
