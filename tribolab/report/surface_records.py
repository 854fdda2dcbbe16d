"""What tables and report say of the surfaces: roughness, contact at the loads, adhesion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.records.part_records import SurfaceRows
from tribolab.untyped import Json

if TYPE_CHECKING:
    from tribolab.records.parts import Row, SurfaceOutcome


def table(rows: Sequence[SurfaceRows], name: str, columns: Sequence[str]) -> pd.DataFrame:
    """Return one of the three tables over all surfaces."""
    parts: list[Row] = [
        {"surface": surface.name, "quality": surface.quality, **row}
        for surface in rows
        for row in (
            [surface.roughness]
            if name == "roughness"
            else (surface.contact if name == "contact" else surface.adhesion)
        )
    ]
    return pd.DataFrame(parts, columns=["surface", "quality", *columns])


def surface_record(surface: SurfaceOutcome, rows: SurfaceRows | None) -> Json:
    """Return a surface for report.json."""
    return {
        "name": surface.name,
        "status": surface.status,
        "reason": surface.reason,
        "error": surface.error,
        "quality": surface.quality,
        "checks": list(surface.checks),
        "files": list(surface.files),
        "data_file": surface.data_file,
        "reused": surface.reused,
        "kept": surface.kept,
        "seconds": surface.seconds,
        "roughness": rows.roughness if rows else None,
        "contact": list(rows.contact) if rows else [],
        "adhesion": list(rows.adhesion) if rows else [],
        "modulus": rows.modulus if rows else "",
        "validity": rows.validity if rows else "",
    }
