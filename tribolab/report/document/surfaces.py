"""What tables and report say of the surfaces: roughness, contact at the loads, adhesion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.records.part_records import SurfaceRows

if TYPE_CHECKING:
    from tribolab.records.parts import Row


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
