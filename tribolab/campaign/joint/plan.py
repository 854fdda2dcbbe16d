"""Which measured curves are fitted together, and what else the fits want to know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.untyped import Arguments
from tribolab.records.parts import ModelOutcome

if TYPE_CHECKING:
    from tribolab.contact.area import AreaTheory


@dataclass(frozen=True)
class Work:
    """A work of adhesion [J/m2] and what it may be; bounds that are not stated are equal to it."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class JointDry:
    """Friction measured without the liquid, at some loads of one surface.

    Parameters
    ----------
    surface
        Whose.
    surface_file
        Data file with its spectrum.
    normal_forces, measured
        Loads [N], and the data files of the curves.
    dry, wet
        Works of adhesion without the liquid and in it.
    """

    surface: str
    surface_file: str
    normal_forces: tuple[float, ...]
    measured: tuple[str, ...]
    dry: Work
    wet: Work


@dataclass(frozen=True)
class JointTask:
    """Measured curves in one liquid, their models, and what else the fit wants to know.

    Parameters
    ----------
    name, surfaces, medium
        What it is of.
    models
        The models, by surface and load.
    measured
        Data files of the measured curves, as the models.
    enhancement
        Real contact area with adhesion over that of the model [1], as the models; None if not
        known.
    dry
        Friction measured without the liquid, by surface; none if it is not to be used.
    contacts
        The table of the contact, by surface.
    area, adhesion
        Theory of the contact area, and whether the models' area is that with adhesion.
    viscosity, viscosity_range
        Of the liquid as stated [Pa s].
    speed_error
        Relative standard uncertainty of the sliding speed, the same at all loads.
    folder, fingerprint
        Where, and what shapes it.
    """

    name: str
    surfaces: tuple[str, ...]
    medium: str
    models: tuple[ModelOutcome, ...]
    measured: tuple[str, ...]
    enhancement: tuple[float | None, ...]
    dry: tuple[JointDry, ...]
    contacts: Mapping[str, Arguments]
    area: AreaTheory
    adhesion: bool
    viscosity: float
    viscosity_range: tuple[float, float] | None
    speed_error: float
    folder: Path
    fingerprint: str = ""

    @property
    def file(self) -> str:
        """Data file relative to the results folder."""
        return f"data/{self.name}.nc"

    @property
    def surface(self) -> str:
        """The surfaces as they are said."""
        *before, last = self.surfaces
        return f"{', '.join(before)} and {last}" if before else last
