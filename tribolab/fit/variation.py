"""Variation of one unknown of a mixed-lubrication model between the ends of its range."""

from __future__ import annotations

from typing import NamedTuple, TypedDict

import xarray as xr

from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import Contact
from tribolab.contact.separation import Separation
from tribolab.lubrication.factors import FlowFactors, RoughBody
from tribolab.lubrication.parameters import Outlet


class Base(NamedTuple):
    """Model before any variation, with the ranges of its inputs."""

    psd: xr.Dataset | None
    rough_body: RoughBody
    friction_factors: bool
    gamma: float
    measured_to: float | None  # wavenumber [1/m] above which the spectrum is extrapolated
    contact: Contact
    load: float  # N/m
    viscosity: float  # Pa s
    viscosity_range: tuple[float, float] | None  # None if unknown
    youngs_modulus_range: tuple[float, float] | None
    inlet_length: float  # m, infinite if not stated
    area: AreaTheory
    work_of_adhesion: float | None = None  # J/m2, None without adhesion
    work_of_adhesion_range: tuple[float, float] | None = None
    load_range: tuple[float, float] | None = None
    radius_range: tuple[float, float] | None = None
    outlet: str = "unknown"  # "unknown", or the stated outlet

    @property
    def spectrum(self) -> xr.Dataset:
        """Spectrum of the surface, for code that is reached only with a rough surface."""
        assert self.psd is not None  # only rough surfaces have variations of roughness
        return self.psd


class Changed(TypedDict, total=False):
    """Arguments of `stribeck_curve` that change at one end of a range."""

    psd: xr.Dataset
    factors: FlowFactors
    separation: Separation
    gamma: float
    rough_body: RoughBody
    friction_factors: bool
    viscosity: float
    contact: Contact
    load: float
    inlet_length: float
    area: AreaTheory
    work_of_adhesion: float
    outlet: Outlet


class Variation(NamedTuple):
    """One unknown, the ends of its range, and the arguments that change at each end."""

    name: str
    reason: str
    texts: tuple[str, str]  # text of the low and the high end; empty for a missing end
    ends: tuple[Changed | None, Changed | None]


class Skipped(NamedTuple):
    """An unknown that cannot be varied, with the reason."""

    name: str
    reason: str
