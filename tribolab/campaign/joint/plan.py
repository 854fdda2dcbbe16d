"""Tasks of the joint fits: the curves fitted together, their models and prior knowledge."""

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
    """Work of adhesion [J/m2] with its bounds; missing bounds are equal to the value."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class JointDry:
    """Friction measured without the liquid, at some loads of one surface.

    Parameters
    ----------
    surface
        Name of the surface.
    surface_file
        Data file with the spectrum of the surface.
    normal_forces, measured
        Loads [N], and the data files of the curves.
    dry, wet
        Work of adhesion without the liquid, and in it.
    """

    surface: str
    surface_file: str
    normal_forces: tuple[float, ...]
    measured: tuple[str, ...]
    dry: Work
    wet: Work


@dataclass(frozen=True)
class JointTask:
    """Measured curves in one liquid, their models, and other inputs of the fit.

    Parameters
    ----------
    name, surfaces, medium
        Name of the fit, its surfaces and the liquid.
    models
        Models, sorted by surface and load.
    measured
        Data files of the measured curves, in the order of the models.
    enhancement
        Ratio of the real contact area with adhesion to that of the model [1], by model; None if
        unknown.
    dry
        Friction measured without the liquid, by surface; empty if not used.
    contacts
        Contact table of each surface.
    area, adhesion
        Theory of the contact area, and whether the models include adhesion in it.
    viscosity, viscosity_range
        Stated viscosity of the liquid and its range [Pa s].
    speed_error
        Relative standard uncertainty of the sliding speed, equal at all loads.
    folder, fingerprint
        Results folder, and checksum of everything that affects the fit.
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
        """Names of the surfaces as a list in words."""
        *before, last = self.surfaces
        return f"{', '.join(before)} and {last}" if before else last
