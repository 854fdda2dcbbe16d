"""Raw files of a run, with checksums."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.provenance import as_text, sha256_of_file

if TYPE_CHECKING:
    from tribolab.campaign.settings.plan import PlannedRun
    from tribolab.core.untyped import Json
    from tribolab.records.parts import Source


def sources_of_run(run: PlannedRun, attrs: Json) -> tuple[Source, ...]:
    """Return the files of a run with the checksums taken while reading."""
    names, sums = (str(attrs.get(key, "")).split("; ") for key in ("source", "source_sha256"))
    known = dict(zip(names, sums, strict=False))
    return tuple(
        (label, known[as_text(file.name)], file.stat().st_size)
        if as_text(file.name) in known
        else source_of(file, label)
        for file, label in zip(run.files, run.labels, strict=True)
    )


def source_of(file: Path, label: str) -> Source:
    """Return label, checksum and size of a file; no checksum if it cannot be read."""
    try:
        return label, sha256_of_file(file), file.stat().st_size
    except OSError:  # missing or unreadable: the outcome of its run reports it
        return label, "", 0
