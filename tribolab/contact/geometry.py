"""Geometry and elasticity of a cylinder or a ball pressed on an elastic flat."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from tribolab.contact.layer import Layer
from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import positive, to_si


class Elasticity(ABC):
    """Parameters common to line and point contacts: radius, layer thickness, elastic constants."""

    radius: float
    youngs_modulus: float
    poisson_ratio: float
    thickness: float
    counter_modulus: float
    counter_poisson_ratio: float
    load_unit: ClassVar[str]
    is_round: ClassVar[bool]

    def __post_init__(self) -> None:
        """Convert text to SI values, and raise an error for impossible ones."""
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            if field.name.endswith("poisson_ratio"):
                number = plane_strain_ratio(value)
            else:
                unit = "Pa" if field.name.endswith("modulus") else "m"
                endless = field.name in ("thickness", "counter_modulus") and value == np.inf
                number = np.inf if endless else positive(value, unit, field.name)
            object.__setattr__(self, field.name, number)

    @property
    def effective_modulus(self) -> float:
        """Effective plane-strain modulus E* [Pa] of both bodies, 1/E* = sum (1 - nu^2)/E."""
        if self.counter_modulus == np.inf:
            return self.youngs_modulus / (1 - self.poisson_ratio**2)
        counter = (1 - self.counter_poisson_ratio**2) / self.counter_modulus
        return 1 / ((1 - self.poisson_ratio**2) / self.youngs_modulus + counter)

    @property
    def compliance_share(self) -> float:
        """Share of the flat in the compliance 1/E* [1]; 1 for a rigid counter body."""
        return self.effective_modulus * (1 - self.poisson_ratio**2) / self.youngs_modulus

    def layer(self, length: float) -> Layer | None:
        """Return the elastic layer with lengths in units of `length` [m]; None for a half-space."""
        if self.thickness == np.inf:
            return None
        return Layer(self.thickness / length, self.poisson_ratio, self.compliance_share)

    @abstractmethod
    def force(self, load: float) -> float:
        """Return the normal force [N] from a load: F_N/L [N/m] of a cylinder, F_N [N] of a ball."""


@dataclass(frozen=True)
class LineContact(Elasticity):
    """Cylinder pressed on an elastic flat.

    Parameters
    ----------
    radius
        Radius R of the cylinder [m], or text such as ``"7 cm"``.
    length
        Axial length L of the contact [m].
    youngs_modulus
        Young's modulus E of the flat [Pa].
    poisson_ratio
        Poisson's ratio of the flat [1], above -1 and at most 0.5.
    thickness
        Thickness [m] of the flat, which is bonded to a rigid base; infinite for a half-space.
    counter_modulus, counter_poisson_ratio
        Young's modulus [Pa] and Poisson's ratio of the cylinder; an infinite modulus is rigid.

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> contact.effective_modulus
    2000000.0
    >>> contact.load("31 N")
    310.0
    """

    radius: float
    length: float
    youngs_modulus: float
    poisson_ratio: float
    thickness: float = np.inf
    counter_modulus: float = np.inf
    counter_poisson_ratio: float = 0.5
    load_unit: ClassVar[str] = "N/m"
    is_round: ClassVar[bool] = False

    def load(self, normal_force: str | float) -> float:
        """Return the load F_N/L [N/m] of a normal force F_N [N]."""
        return to_si(normal_force, "N", name="normal_force") / self.length

    def force(self, load: float) -> float:
        """Return the normal force F_N [N] of a load F_N/L [N/m]."""
        return load * self.length


@dataclass(frozen=True)
class PointContact(Elasticity):
    """Ball pressed on an elastic flat.

    Parameters
    ----------
    radius
        Radius R of the ball [m], or text such as ``"9.5 mm"``.
    youngs_modulus, poisson_ratio, thickness, counter_modulus, counter_poisson_ratio
        As for `LineContact`, the counter body being the ball.

    Examples
    --------
    >>> contact = PointContact("9.5 mm", "1 MPa", 0.5)
    >>> f"{contact.effective_modulus / 1e6:.3f} MPa", contact.load("3 N")
    ('1.333 MPa', 3.0)
    """

    radius: float
    youngs_modulus: float
    poisson_ratio: float
    thickness: float = np.inf
    counter_modulus: float = np.inf
    counter_poisson_ratio: float = 0.5
    load_unit: ClassVar[str] = "N"
    is_round: ClassVar[bool] = True

    def load(self, normal_force: str | float) -> float:
        """Return the load of a ball, which is the normal force F_N [N] itself."""
        return to_si(normal_force, "N", name="normal_force")

    def force(self, load: float) -> float:
        """Return the normal force [N] of a ball, which is its load itself."""
        return load


Contact = LineContact | PointContact


def make_contact(geometry: str = "cylinder", **known: float) -> Contact:
    """Return a `PointContact` for a ``"ball"`` or a `LineContact` for a ``"cylinder"``."""
    return PointContact(**known) if geometry == "ball" else LineContact(**known)


def plane_strain_ratio(value: str | float) -> float:
    """Return a checked Poisson's ratio as a number; 0.5 (rubber) is allowed.

    Raises
    ------
    AnalysisError
        If it is not above -1 and at most 0.5.
    """
    ratio = to_si(value if isinstance(value, str) else float(value), "1", name="poisson_ratio")
    if not -1 < ratio <= 0.5:
        raise AnalysisError(
            f"poisson_ratio: a value above -1 and at most 0.5 is wanted; got {ratio:g}"
        )
    return ratio
