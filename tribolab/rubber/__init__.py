"""Rubber: viscoelastic modulus and hysteresis friction on rough surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.rubber.friction import viscoelastic_friction
    from tribolab.rubber.modulus import read_modulus
    from tribolab.rubber.prony import PronySeries
    from tribolab.rubber.temperature import WilliamsLandelFerry, flash_temperature, modulus_at
    from tribolab.rubber.two_bodies import RubberBody, two_body_friction

__all__ = [
    "PronySeries",
    "RubberBody",
    "WilliamsLandelFerry",
    "flash_temperature",
    "modulus_at",
    "read_modulus",
    "two_body_friction",
    "viscoelastic_friction",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "PronySeries": "prony",
        "RubberBody": "two_bodies",
        "WilliamsLandelFerry": "temperature",
        "flash_temperature": "temperature",
        "modulus_at": "temperature",
        "read_modulus": "modulus",
        "two_body_friction": "two_bodies",
        "viscoelastic_friction": "friction",
    },
)
