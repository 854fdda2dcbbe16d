"""Friction of line contacts at rest and in motion, as stored before other contacts were added.

``python tests/lubrication/line_contact_numbers.py`` writes them again.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import tribolab as tl
from tribolab.studies import xu2026

STORED = Path(__file__).parents[1] / "kept_results" / "line_contacts.json"
SPEEDS = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1]
KEPT = (
    "friction_coefficient", "friction_coefficient_couette", "friction_coefficient_pressure",
    "friction_per_shear_stress", "minimum_separation", "central_separation", "solid_load_share",
)  # fmt: skip


def computed() -> dict[str, dict[str, list[float]]]:
    """Compute the curves that are stored."""
    curves = {
        name: tl.stribeck_curve(xu2026.contact, psd, "1.4 Pa s", load, 1e5, speeds)
        for name, psd, load, speeds in (
            ("smooth", None, "310 N/m", SPEEDS[3:]),
            ("Sb-S", xu2026.psd("Sb-S"), "310 N/m", SPEEDS),
            ("Sb-R", xu2026.psd("Sb-R"), "2110 N/m", SPEEDS),
        )
    }
    return {
        name: {part: np.asarray(curve[part].values).tolist() for part in KEPT}
        for name, curve in curves.items()
    }


if __name__ == "__main__":
    STORED.write_text(json.dumps(computed(), indent=1) + "\n")
