"""Inputs of the sliding mode: properties of a contact, and pieces of evidence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

NO_STICK_SLIP = "no stick-slip"


LOCAL = "local stick-slip"


SUSPECTED = "adhesion-controlled macroscopic instability suspected"


UNEXPLAINED = "stick-slip of unknown origin"


UNKNOWN = "not known"


@dataclass(frozen=True)
class Mode:
    """Properties of a contact besides its curves, in SI; None if unknown.

    Parameters
    ----------
    work_of_adhesion, work_of_adhesion_range
        gamma_eff(1) [J/m2] of this surface in this medium, and its bounds.
    area_ratio, pressure
        A/A0 with adhesion at the load [1], and the nominal pressure [Pa].
    rough_shear_stress
        sigma_f [Pa] of a surface that slides steadily, corrected for the adhesive area.
    youngs_modulus
        [Pa]
    fluid
        Whether there is a fluid between the surfaces.

    Examples
    --------
    >>> Mode(work_of_adhesion=2e-3, area_ratio=0.9).pressure is None
    True
    """

    work_of_adhesion: float | None = None
    work_of_adhesion_range: tuple[float, float] | None = None
    area_ratio: float | None = None
    pressure: float | None = None
    rough_shear_stress: float | None = None
    youngs_modulus: float | None = None
    fluid: bool = True


FOR, AGAINST, UNTOUCHED = "for", "against", "neutral"


class Evidence(NamedTuple):
    """Piece of evidence for or against an adhesion-controlled sliding mode, or neutral."""

    side: str
    text: str
    topic: str
