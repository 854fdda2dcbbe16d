"""Analysis of friction signals: segments, friction coefficients, measured curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.friction.mean_error.block_means import error_from_blocks as error_from_blocks
    from tribolab.friction.coefficient.cycles import friction_per_cycle as friction_per_cycle
    from tribolab.friction.decisions.decision import Decision as Decision
    from tribolab.friction.inertia import (
        moving_mass as moving_mass,
        without_inertia as without_inertia,
    )
    from tribolab.friction.oscillation.slip_curve import stick_slip_curve as stick_slip_curve
    from tribolab.friction.traction import traction_curves as traction_curves

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
