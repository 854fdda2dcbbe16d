"""SDF files with the signature of the draft standard: ``aBCR-1.0``, ``bBCR-1.0``.

Their layout is that of ``aISO-1.0`` and ``bISO-1.0``, the only ones SurfaceTopography (1.27) reads.
"""

from __future__ import annotations

import functools
from pathlib import Path

from tribolab.reading.raw.scratch import scratch_copy

_DRAFTS = {b"aBCR-1.0": b"aISO-1.0", b"bBCR-1.0": b"bISO-1.0"}
_MARK = 8  # bytes


def is_sdf_draft(head: bytes) -> bool:
    """Whether a file begins like the draft format.

    >>> is_sdf_draft(b"aBCR-1.0"), is_sdf_draft(b"aISO-1.0")
    (True, False)
    """
    return head[:_MARK] in _DRAFTS


def as_standard(path: Path) -> Path:
    """Return a copy of such a file with the signature of the standard."""
    state = path.stat()
    return _copied(path.resolve(), state.st_size, state.st_mtime_ns)


@functools.lru_cache(maxsize=8)
def _copied(path: Path, size: int, modified: int) -> Path:
    content = path.read_bytes()
    return scratch_copy(path, _DRAFTS[content[:_MARK]] + content[_MARK:])
