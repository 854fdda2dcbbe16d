"""Rubber: viscoelastic modulus, and hysteresis friction on rough surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.rubber.friction import viscoelastic_friction as viscoelastic_friction
    from tribolab.rubber.modulus import read_modulus as read_modulus
    from tribolab.rubber.prony import PronySeries as PronySeries
    from tribolab.rubber.temperature import (
        WilliamsLandelFerry as WilliamsLandelFerry,
        flash_temperature as flash_temperature,
        modulus_at as modulus_at,
    )
    from tribolab.rubber.two_bodies import (
        RubberBody as RubberBody,
        two_body_friction as two_body_friction,
    )

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
