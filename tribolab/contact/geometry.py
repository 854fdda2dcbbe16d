"""The line contact: a rigid cylinder on an elastic flat."""

from __future__ import annotations

from dataclasses import dataclass

from tribolab.errors import AnalysisError
from tribolab.units import positive, to_si


@dataclass(frozen=True)
class LineContact:
    """A rigid cylinder pressed on an elastic half-space.

    Parameters
    ----------
    radius
        Radius R of the cylinder [m], or text such as ``"7 cm"``.
    length
        Axial length L of the contact [m].
    youngs_modulus
        Young's modulus E of the half-space [Pa].
    poisson_ratio
        Poisson's ratio of the half-space [1], above -1 and at most 0.5.

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

    def __post_init__(self) -> None:
        """Turn text into SI floats and refuse what is no contact."""
        for name, unit in (("radius", "m"), ("length", "m"), ("youngs_modulus", "Pa")):
            object.__setattr__(self, name, positive(getattr(self, name), unit, name))
        object.__setattr__(self, "poisson_ratio", plane_strain_ratio(self.poisson_ratio))

    @property
    def effective_modulus(self) -> float:
        """Plane-strain modulus E* = E/(1 - nu^2) [Pa] of the half-space; the cylinder is rigid."""
        return self.youngs_modulus / (1 - self.poisson_ratio**2)

    def load(self, normal_force: str | float) -> float:
        """Load F_N/L [N/m] of a normal force [N]."""
        return to_si(normal_force, "N", name="normal_force") / self.length


def plane_strain_ratio(value: str | float) -> float:
    """Return a Poisson's ratio as a float; 0.5 (rubber) is allowed, as E/(1 - nu^2) stays finite.

    Raises
    ------
    AnalysisError
        If it does not lie above -1 and at or below 0.5.
    """
    ratio = to_si(value if isinstance(value, str) else float(value), "1", name="poisson_ratio")
    if not -1 < ratio <= 0.5:
        raise AnalysisError(
            f"poisson_ratio: a value above -1 and at most 0.5 is wanted; got {ratio:g}"
        )
    return ratio
