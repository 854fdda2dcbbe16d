"""Contact mechanics of a soft flat and a rough cylinder or ball.

Load is force per unit length [N/m]; pressure is nominal, averaged over the roughness.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.contact.adhesion_error import adhesion_uncertainty
    from tribolab.contact.adhesive_contact import adhesion, macroscopic_work_of_adhesion
    from tribolab.contact.gap import gap_distribution
    from tribolab.contact.line import rough_line_contact
    from tribolab.contact.persson import contact_area_ratio, mean_separation
    from tribolab.contact.point import rough_point_contact
    from tribolab.contact.rolling import rolling_friction
    from tribolab.contact.separation import separation_table
    from tribolab.contact.work_of_adhesion import SurfaceEnergies, work_of_adhesion_spread

__all__ = [
    "SurfaceEnergies",
    "adhesion",
    "adhesion_uncertainty",
    "contact_area_ratio",
    "gap_distribution",
    "macroscopic_work_of_adhesion",
    "mean_separation",
    "rolling_friction",
    "rough_line_contact",
    "rough_point_contact",
    "separation_table",
    "work_of_adhesion_spread",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "SurfaceEnergies": "work_of_adhesion",
        "adhesion": "adhesive_contact",
        "adhesion_uncertainty": "adhesion_error",
        "contact_area_ratio": "persson",
        "gap_distribution": "gap",
        "macroscopic_work_of_adhesion": "adhesive_contact",
        "mean_separation": "persson",
        "rolling_friction": "rolling",
        "rough_line_contact": "line",
        "rough_point_contact": "point",
        "separation_table": "separation",
        "work_of_adhesion_spread": "work_of_adhesion",
    },
)
