"""Analysis of friction signals: segments, friction coefficients, measured curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.friction.blocks import error_from_blocks
    from tribolab.friction.coefficient.cycles import friction_per_cycle
    from tribolab.friction.coefficient.friction_loop import half_loops
    from tribolab.friction.decisions.decision import Decision
    from tribolab.friction.inertia import moving_mass, without_inertia
    from tribolab.friction.oscillation.slip_curve import stick_slip_curve
    from tribolab.friction.traction import traction_curves

__all__ = [
    "Decision",
    "error_from_blocks",
    "friction_per_cycle",
    "half_loops",
    "moving_mass",
    "stick_slip_curve",
    "traction_curves",
    "without_inertia",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "Decision": "decisions.decision",
        "error_from_blocks": "blocks",
        "friction_per_cycle": "coefficient.cycles",
        "half_loops": "coefficient.friction_loop",
        "moving_mass": "inertia",
        "stick_slip_curve": "oscillation.slip_curve",
        "traction_curves": "traction",
        "without_inertia": "inertia",
    },
)
