"""Mixed lubrication of rough line and point contacts: flow factors, solver, curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.lubrication.factors import flow_factors
    from tribolab.lubrication.film import film_profile
    from tribolab.lubrication.parameters import Interface, Solver
    from tribolab.lubrication.relative_factors import relative_flow_factors
    from tribolab.lubrication.stribeck import with_shear_stress
    from tribolab.lubrication.viscosity import liquid_viscosity

__all__ = [
    "Interface",
    "Solver",
    "film_profile",
    "flow_factors",
    "liquid_viscosity",
    "relative_flow_factors",
    "with_shear_stress",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "Interface": "parameters",
        "Solver": "parameters",
        "film_profile": "film",
        "flow_factors": "factors",
        "liquid_viscosity": "viscosity",
        "relative_flow_factors": "relative_factors",
        "with_shear_stress": "stribeck",
    },
)
