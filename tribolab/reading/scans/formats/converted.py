"""Files converted for SurfaceTopography (1.27): Digital Surf, and SDF of the draft standard.

Since 2010 the makers of Surf software compress the heights (``DSCOMPRESSED``) by default; units are
in Latin-1. SDF with ``aBCR-1.0`` or ``bBCR-1.0`` has the layout of ``aISO-1.0`` or ``bISO-1.0``.
"""

from __future__ import annotations

import functools
import struct
import zlib
from pathlib import Path

from tribolab.core.errors import ReadError, brief
from tribolab.reading.raw.scratch import scratch_copy

_PLAIN, _PACKED = b"DIGITAL SURF", b"DSCOMPRESSED"
_HEADER = 512
_UNITS = slice(180, 276)  # six of 16 bytes
_UTF8_MICRO, _MICRO = "µ".encode(), "µ".encode("latin-1")


def is_sur(head: bytes) -> bool:
    """Whether a file begins like a Surf file."""
    return head.startswith((_PLAIN, _PACKED))


def plain_sur(path: Path) -> Path:
    """Return a Surf file that SurfaceTopography can read: the file, or an uncompressed copy.

    Raises
    ------
    ReadError
        If it is incomplete or damaged.
    """
    with path.open("rb") as file:
        header = file.read(_HEADER)
    if header.startswith(_PLAIN) and _UTF8_MICRO not in header[_UNITS]:
        return path
    state = path.stat()
    return _uncompressed(path.resolve(), state.st_size, state.st_mtime_ns)


@functools.lru_cache(maxsize=8)
def _uncompressed(path: Path, size: int, modified: int) -> Path:
    content = path.read_bytes()
    try:
        bits, (nx, ny) = (
            *struct.unpack_from("<h", content, 98),
            struct.unpack_from("<2i", content, 108),
        )
        comment, private = struct.unpack_from("<2H", content, 334)
        units = b"".join(
            content[at : at + 16].replace(_UTF8_MICRO, _MICRO).ljust(16, b"\0")[:16]
            for at in range(_UNITS.start, _UNITS.stop, 16)
        )
        body = content[_HEADER + comment + private :]
        if content.startswith(_PACKED):
            body = _unpacked(body, nx * ny * (bits // 8))
    except (struct.error, zlib.error, ValueError) as error:
        raise ReadError(
            f"{path}: the Surf file is damaged: {brief(error)}; is it whole?"
        ) from error
    header = _PLAIN + content[12 : _UNITS.start] + units + content[_UNITS.stop : _HEADER]
    return scratch_copy(path, header + content[_HEADER : _HEADER + comment + private] + body)


def _unpacked(body: bytes, size: int) -> bytes:
    """Decompress the streams of a file, limited to the size of the heights."""
    (number,) = struct.unpack_from("<I", body)
    if not 0 < number <= 1024 or size < 0:
        raise ValueError(f"{number} packed parts of {size} bytes")
    lengths = [struct.unpack_from("<2I", body, 4 + 8 * part) for part in range(number)]
    at, parts = 4 + 8 * number, []
    for plain, packed in lengths:
        if plain > size:
            raise ValueError(f"a packed part of {plain} bytes, but the heights take {size}")
        parts.append(zlib.decompressobj().decompress(body[at : at + packed], plain or 1))
        at += packed
    whole = b"".join(parts)
    if len(whole) < size:
        raise ValueError(f"{len(whole)} bytes of heights, but {size} are wanted")
    return whole


_DRAFTS = {b"aBCR-1.0": b"aISO-1.0", b"bBCR-1.0": b"bISO-1.0"}
_DRAFT_MARK = 8  # bytes of the signature


def is_sdf_draft(head: bytes) -> bool:
    """Whether a file begins like SDF of the draft standard.

    >>> is_sdf_draft(b"aBCR-1.0"), is_sdf_draft(b"aISO-1.0")
    (True, False)
    """
    return head[:_DRAFT_MARK] in _DRAFTS


def as_standard(path: Path) -> Path:
    """Return a copy of an SDF file of the draft standard with the signature of the final one."""
    state = path.stat()
    return _restamped(path.resolve(), state.st_size, state.st_mtime_ns)


@functools.lru_cache(maxsize=8)
def _restamped(path: Path, size: int, modified: int) -> Path:
    content = path.read_bytes()
    return scratch_copy(path, _DRAFTS[content[:_DRAFT_MARK]] + content[_DRAFT_MARK:])
