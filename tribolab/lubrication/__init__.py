"""Mixed lubrication of rough line and point contacts: flow factors, films, Stribeck curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.lubrication.factors import (
        flow_factors as flow_factors,
        relative_flow_factors as relative_flow_factors,
    )
    from tribolab.lubrication.film import film_profile as film_profile
    from tribolab.lubrication.parameters import Interface as Interface, Solver as Solver
    from tribolab.lubrication.stribeck import with_shear_stress as with_shear_stress
    from tribolab.lubrication.viscosity import liquid_viscosity as liquid_viscosity

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
