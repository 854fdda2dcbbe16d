"""Reference system: PMMA cylinders on PDMS, dry and in glycerol (Xu et al. 2026).

R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the Stribeck
curve in hydrophobic soft contacts" (2026). Section and equation numbers below are that paper's.

The power spectra are **stand-ins**: the measured ones are published as a picture only. Each is a
plateau and a power law with the paper's roughness and slope; its exponent H was chosen to reproduce
the paper's adhesive contact areas. All results based on them state this.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.contact.geometry import LineContact
from tribolab.contact.work_of_adhesion import PDMS_PMMA_GLYCEROL
from tribolab.core.errors import AnalysisError, nearest
from tribolab.studies.published import Published, read_published
from tribolab.surface.self_affine import SelfAffine, psd_2d, tabulate
from tribolab.units.stamping import stamp

CITATION = (
    "R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, Adhesion-controlled sliding and the "
    "Stribeck curve in hydrophobic soft contacts (2026)"
)
STAND_IN = (
    "stand-in: the paper's measured spectrum is not public; plateau and power law with the "
    "paper's h_rms and rms slope"
)


@dataclass(frozen=True)
class ReferenceSystem:
    """Rigid cylinder on an elastic flat, in a liquid (Sec. 3 and 4).

    Parameters
    ----------
    radius, length
        Radius and length of the cylinder [m].
    youngs_modulus, poisson_ratio
        E [Pa] and nu [1] of the rubber.
    viscosity
        Viscosity of glycerol [Pa s].
    loads
        Normal forces [N].
    lowest_speed, highest_speed
        Ends of the sliding speeds [m/s].

    Examples
    --------
    >>> f"{ReferenceSystem().nominal_pressure(31.0) / 1e3:.1f} kPa"
    '41.7 kPa'
    """

    radius: float = 0.07  # m
    length: float = 0.10  # m
    youngs_modulus: float = 1.5e6  # Pa
    poisson_ratio: float = 0.5
    viscosity: float = 1.4  # Pa s, glycerol
    loads: tuple[float, ...] = (31.0, 91.0, 151.0, 211.0)  # N
    lowest_speed: float = 1e-6  # m/s
    highest_speed: float = 1e-2  # m/s

    @property
    def effective_modulus(self) -> float:
        """Plane-strain modulus E* = E/(1 - nu^2) [Pa]."""
        return self.youngs_modulus / (1 - self.poisson_ratio**2)

    def half_width(self, normal_force: float) -> float:
        """Return the half-width a [m] of the Hertz line contact, Eq. (16)."""
        load = normal_force / self.length
        return math.sqrt(4 * self.radius * load / (math.pi * self.effective_modulus))

    def nominal_pressure(self, normal_force: float) -> float:
        """Return the mean Hertz pressure F/(2 a L) [Pa], the paper's sigma_0."""
        return normal_force / (2 * self.half_width(normal_force) * self.length)


@dataclass(frozen=True)
class Profilometer:
    """Stylus instrument, a Surftest SJ-410 (Sec. 3).

    Parameters
    ----------
    tip_radius, pitch, scan_length
        Radius of the stylus, distance between points, and length of a scan [m].
    scans
        Number of scans of a cylinder.

    Examples
    --------
    >>> round(Profilometer().scan_length / Profilometer().pitch)
    50000
    """

    tip_radius: float = 2e-6  # m
    pitch: float = 0.5e-6  # m
    scan_length: float = 25e-3  # m
    scans: int = 3


@dataclass(frozen=True)
class StudySurface:
    """Cylinder with its roughness, contact areas and fitted shear stresses.

    Parameters
    ----------
    name
        Name of the surface in the paper.
    spectrum
        Stand-in for the measured power spectrum.
    rms_roughness, rms_slope
        Published h_rms [m] and slope [1] of the full spectrum (Sec. 4, App. A).
    area_ratio, area_ratio_glycerol, area_ratio_dry
        Published A/A0 at the lowest load: without adhesion, with adhesion in glycerol and dry
        (Sec. 5).
    shear_stress
        Fitted sigma_f [Pa] by normal force [N] in glycerol (Sec. 7), for the area without
        adhesion.

    Examples
    --------
    >>> surfaces["Sb-S"].area_ratio_glycerol / surfaces["Sb-S"].area_ratio > 1.7
    True
    """

    name: str
    spectrum: SelfAffine
    rms_roughness: float
    rms_slope: float
    area_ratio: float
    area_ratio_glycerol: float
    area_ratio_dry: float
    shear_stress: tuple[tuple[float, float], ...]


system = ReferenceSystem()
profilometer = Profilometer()
contact = LineContact(system.radius, system.length, system.youngs_modulus, system.poisson_ratio)

# Table of the numbers as printed in the paper.
published: tuple[Published, ...] = read_published(Path(__file__).with_name("xu2026_published.csv"))

# 1, 2.15 and 4.64 in each decade: equal steps on a logarithmic scale.
SPEEDS = tuple(round(m * 10.0**e, 9) for e in range(-6, -2) for m in (1.0, 2.15, 4.64)) + (1e-2,)

# q0 = pi / d0, with d0 the Hertz width at the lowest load; q1 = pi / 1 nm.
_LOW, _HIGH = 423.0, math.pi / 1e-9


def _pairs(*stresses: float) -> tuple[tuple[float, float], ...]:
    return tuple(zip(system.loads, stresses, strict=False))


_SURFACES = (
    StudySurface(
        name="Smooth",
        spectrum=SelfAffine(1.090, 4.666116e4, 1.435334e-22, _LOW, _HIGH),
        rms_roughness=1.372e-6,
        rms_slope=0.147,
        area_ratio=0.224,
        area_ratio_glycerol=0.876,
        area_ratio_dry=0.924,
        shear_stress=_pairs(0.50e6),
    ),
    StudySurface(
        name="Sb-S",
        spectrum=SelfAffine(1.155, 9.053363e4, 1.629575e-22, _LOW, _HIGH),
        rms_roughness=2.798e-6,
        rms_slope=0.480,
        area_ratio=0.0692,
        area_ratio_glycerol=0.119,
        area_ratio_dry=0.1313,
        shear_stress=_pairs(0.84e6, 0.78e6, 0.70e6, 0.65e6),
    ),
    StudySurface(
        name="Sb-R",
        spectrum=SelfAffine(1.190, 2.804894e4, 5.461285e-20, _LOW, _HIGH),
        rms_roughness=15.76e-6,
        rms_slope=0.778,
        area_ratio=0.0428,
        area_ratio_glycerol=0.052,
        area_ratio_dry=0.0528,
        # the last stress is kept as printed, 0.98 MPa, although the figure's name and the ratio of
        # 1.75 to 1.95 to Sb-S in the text require 0.94 MPa
        shear_stress=_pairs(1.08e6, 1.08e6, 1.00e6, 0.98e6),
    ),
)
surface_energies = PDMS_PMMA_GLYCEROL
surfaces: dict[str, StudySurface] = {surface.name: surface for surface in _SURFACES}


def surface(name: str) -> StudySurface:
    """Return the cylinder with a given name: ``"Smooth"``, ``"Sb-S"`` or ``"Sb-R"``, in any case.

    Raises
    ------
    AnalysisError
        If the paper has no such surface.

    Examples
    --------
    >>> surface("sb-s").rms_slope
    0.48
    """
    for known in surfaces.values():
        if known.name.lower() == name.lower():
            return known
    raise AnalysisError(f"xu2026 has no surface '{name}'{nearest(name, surfaces)}")


def psd(name: str | Sequence[str], points: int = 1201) -> xr.Dataset:
    """Return the stand-in for the measured power spectrum of a surface, from q0 to q1.

    Parameters
    ----------
    name
        ``"Smooth"``, ``"Sb-S"`` or ``"Sb-R"``; or several of them.
    points
        Number of wavenumbers.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` [m4] over ``wavenumber`` [1/m], in the convention of `SelfAffine`; for several
        surfaces over (surface, wavenumber), with a node at the roll-off of each.

    Examples
    --------
    >>> psd("Sb-S").psd_2d.attrs["units"]
    'm4'
    """
    if not isinstance(name, str):
        return _several([surface(each) for each in name], points)
    known = surface(name)
    return tabulate(known.spectrum, points).assign_attrs(
        surface=known.name, origin=STAND_IN, references=CITATION
    )


def _several(known: list[StudySurface], points: int) -> xr.Dataset:
    spectra = [each.spectrum for each in known]
    low, high = min(each.low for each in spectra), max(each.high for each in spectra)
    q = np.union1d(np.geomspace(low, high, points), [each.rolloff for each in spectra])
    values = np.array([psd_2d(each, q) for each in spectra])
    names = np.array([each.name for each in known], dtype=object)
    data = xr.Dataset(
        {"psd_2d": (("surface", "wavenumber"), values)}, {"surface": names, "wavenumber": q}
    )
    return stamp(data, convention="<h^2> = 2 pi int q C dq", origin=STAND_IN, references=CITATION)
