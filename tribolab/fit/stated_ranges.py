"""Model inputs that are varied over ranges stated by the user."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from tribolab.fit.variation import Base, Changed, Skipped, Variation


@dataclass(frozen=True)
class StatedRange:
    """Model input that is varied over its stated range.

    Parameters
    ----------
    name, argument
        Displayed name; argument of `model_uncertainty` without ``_range``.
    reason
        Reason for the variation.
    shown
        Function that returns an end of the range as text.
    changed
        Function that returns the arguments changed by an end of the range.
    """

    name: str
    argument: str
    reason: str
    shown: Callable[[float], str]
    changed: Callable[[Base, float], Changed]

    def __call__(self, base: Base) -> Variation | Skipped:
        """Return the variation of the input over its stated range."""
        ends = getattr(base, f"{self.argument}_range")
        if ends is None:
            return Skipped(self.name, f"no {self.argument}_range was given")
        low, high = ends
        return Variation(
            self.name,
            f"as stated; {self.reason}",
            (self.shown(low), self.shown(high)),
            (self.changed(base, low), self.changed(base, high)),
        )


VISCOSITY = StatedRange(
    "viscosity",
    "viscosity",
    "that of a liquid depends on temperature and on the water it takes up",
    lambda value: f"{value:.3g} Pa s",
    lambda base, value: {"viscosity": value},
)
YOUNGS_MODULUS = StatedRange(
    "Young's modulus",
    "youngs_modulus",
    "that of an elastomer depends on batch, cure, age and frequency",
    lambda value: f"{value / 1e6:.3g} MPa",
    lambda base, value: {"contact": replace(base.contact, youngs_modulus=value)},
)
LOAD_RANGE = StatedRange(
    "load",
    "load",
    "it depends on the force cell and on the length that carries it",
    lambda value: f"{value:.4g} N/m",
    lambda base, value: {"load": value},
)
RADIUS_RANGE = StatedRange(
    "radius",
    "radius",
    "of a ground or cast cylinder it is that near the contact",
    lambda value: f"{1e3 * value:.4g} mm",
    lambda base, value: {"contact": replace(base.contact, radius=value)},
)
WORK_OF_ADHESION = StatedRange(
    "work of adhesion",
    "work_of_adhesion",
    "it depends on surface energies and contact angles, which differ between sources",
    lambda value: f"{1e3 * value:.3g} mJ/m²",
    lambda base, value: {"work_of_adhesion": value},
)
