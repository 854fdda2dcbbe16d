"""Safety checks of zip archives, including workbooks and x3p, against zip bombs."""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from tribolab.reading.raw.opening import RefusedError, largest_unpacked
from tribolab.reading.raw.xml_safety import refuse_deep

_BLOCK = 1 << 20


# exceptions of zipfile for damaged, encrypted or unsupported archives
ZIP_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, struct.error, OSError, EOFError, RuntimeError, ValueError),
)


def refuse_bomb(path: Path) -> None:
    """Raise if an archive unpacks to far more than its size, or has too deep XML.

    Raises
    ------
    RefusedError
        If the archive exceeds a limit.
    """
    size = path.stat().st_size
    with zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        unpacked = sum(member.file_size for member in members)
        if unpacked > largest_unpacked(size):
            raise RefusedError(
                f"{path}: the file unpacks to {unpacked / 1e6:.0f} MB, {unpacked / size:.0f} times "
                "its size; that is no measurement. Export the data as text (csv)"
            )
        for member in members:
            if member.filename.lower().endswith((".xml", ".rels")):
                with archive.open(member) as file:
                    refuse_deep(path, member.filename, _blocks(file))


def _blocks(file: IO[bytes]) -> Iterator[bytes]:
    while block := file.read(_BLOCK):
        yield block
