"""Contact mechanics of a soft flat and a rough cylinder or ball.

Load is force per unit length [N/m]; pressure is nominal, averaged over the roughness.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.contact.adhesion_error import adhesion_uncertainty as adhesion_uncertainty
    from tribolab.contact.adhesive_contact import (
        adhesion as adhesion,
        macroscopic_work_of_adhesion as macroscopic_work_of_adhesion,
    )
    from tribolab.contact.gap import gap_distribution as gap_distribution
    from tribolab.contact.line import rough_line_contact as rough_line_contact
    from tribolab.contact.persson import (
        contact_area_ratio as contact_area_ratio,
        mean_separation as mean_separation,
    )
    from tribolab.contact.point import rough_point_contact as rough_point_contact
    from tribolab.contact.rolling import rolling_friction as rolling_friction
    from tribolab.contact.separation import separation_table as separation_table
    from tribolab.contact.work_of_adhesion import (
        SurfaceEnergies as SurfaceEnergies,
        work_of_adhesion_spread as work_of_adhesion_spread,
    )

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
