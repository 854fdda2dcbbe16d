"""What is not known of a mixed-lubrication model, one at a time: changed spectra and settings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypedDict

import numpy as np
import xarray as xr

from tribolab.contact.area import AreaTheory, other_area
from tribolab.contact.geometry import LineContact
from tribolab.contact.separation import separation_table
from tribolab.errors import AnalysisError
from tribolab.lubrication.domain import SHORTEST, half_width
from tribolab.lubrication.factors import CUTOFF, PERCOLATION, FlowFactors, RoughBody, flow_factors
from tribolab.surface.extrapolation import MEASURED, TO_LARGE, TO_SMALL
from tribolab.surface.moments import band, spectrum_arrays

_NORMAL = 1.959963984540054  # 95 % of a normal distribution, as the bands of spectra
_HURST = 0.1
_ATOM = 0.3e-9  # m
_COARSER = 10.0
_PLATEAU = 2.0
_OPEN, _SHUT = 0.40, 0.50
_CUTOFFS = 0.3e-9, 3e-9
_GAMMA = 0.5
# What no variation reaches, between any surfaces and between rough ones.
FIXED = (
    ("geometry and load", "radius, length, Poisson's ratio and normal force are taken as stated"),
    ("liquid", "Newtonian and isothermal, its viscosity the same at every pressure and shear rate"),
    ("cavitation", "the liquid ruptures at the pressure outside"),
    ("elasticity", "linear and without loss, of a half-space"),
)
FIXED_IF_ROUGH = (
    ("shear stress in the contact", "the same at every speed, load and temperature"),
    ("contact area", "without adhesion, at rest"),
    ("roughness", "Gaussian, isotropic and on one of the bodies"),
    ("form of the flow factors", "effective-medium theory of the gaps' distribution"),
)

WITH_ADHESION = "with adhesion in its mean field, at rest; films and pressures are without it"


class Base(NamedTuple):
    """The model that is varied."""

    psd: xr.Dataset | None
    rough_body: RoughBody
    friction_factors: bool
    gamma: float
    measured_to: float | None  # wavenumber [1/m] above which the spectrum is a guess
    contact: LineContact
    load: float  # [N/m]
    viscosity: float  # [Pa s]
    viscosity_range: tuple[float, float] | None  # None if it is not known
    youngs_modulus_range: tuple[float, float] | None
    inlet_length: float  # [m], infinite if nothing is stated
    area: AreaTheory
    work_of_adhesion: float | None = None  # [J/m2], None if the model is without adhesion
    work_of_adhesion_range: tuple[float, float] | None = None
    load_range: tuple[float, float] | None = None
    radius_range: tuple[float, float] | None = None

    @property
    def spectrum(self) -> xr.Dataset:
        """The spectrum of a rough surface."""
        assert self.psd is not None  # what is `OF_ROUGHNESS` is varied of rough surfaces alone
        return self.psd


class Changed(TypedDict, total=False):
    """Arguments of `stribeck_curve` that one end of a range changes."""

    psd: xr.Dataset
    factors: FlowFactors
    gamma: float
    rough_body: RoughBody
    friction_factors: bool
    viscosity: float
    contact: LineContact
    load: float
    inlet_length: float
    area: AreaTheory
    work_of_adhesion: float


class Variation(NamedTuple):
    """One unknown, the ends of its range, and what each end changes in `stribeck_curve`."""

    name: str
    reason: str
    texts: tuple[str, str]  # of the low and the high end; empty where there is only one
    ends: tuple[Changed | None, Changed | None]


class Skipped(NamedTuple):
    """An unknown that cannot be varied here, and why."""

    name: str
    reason: str


def spectrum_band(base: Base) -> Variation | Skipped:
    """Move the measured part to the ends of its band, what is extrapolated along with it."""
    psd = base.spectrum
    if "psd_2d_low" not in psd or "psd_2d_high" not in psd:
        return Skipped("spectrum band", "the spectrum has no psd_2d_low and psd_2d_high")
    q, c = spectrum_arrays(psd)
    seen = np.flatnonzero((_origin(psd) == MEASURED) & (c > 0))
    if seen.size == 0:
        return Skipped("spectrum band", "no part of the spectrum is marked as measured")
    ends: list[Changed] = []
    spread = []
    for name in ("psd_2d_low", "psd_2d_high"):
        ratio = psd[name].values[seen] / c[seen]
        if not np.all(np.isfinite(ratio) & (ratio > 0)):
            return Skipped("spectrum band", f"'{name}' is not above zero everywhere")
        spread.append(ratio)
        along = np.exp(np.interp(np.log(q), np.log(q[seen]), np.log(ratio)))
        ends.append({"psd": _spectrum(q, c * along)})
    if np.all(spread[0] == 1) and np.all(spread[1] == 1):
        return Skipped("spectrum band", "the band has no width")
    middle = [float(np.exp(np.mean(np.log(ratio)))) for ratio in spread]
    return Variation(
        "spectrum band",
        "its 95 % band, every wavenumber at the same end: scans of one surface err together",
        (f"C x {middle[0]:.2f} in the mean", f"C x {middle[1]:.2f} in the mean"),
        (ends[0], ends[1]),
    )


def long_waves(base: Base) -> Variation | Skipped:
    """Leave out what was extrapolated to small wavenumbers, or take more of it."""
    psd, name = base.spectrum, "spectrum at long waves"
    q, c = spectrum_arrays(psd)
    guessed = _origin(psd) == TO_SMALL
    if not guessed.any() or guessed.all():
        return Skipped(name, "no part of the spectrum was extrapolated to small wavenumbers")
    first = q[~guessed][0]
    reason, more = "a plateau is assumed there; without it, and twice as high", _PLATEAU
    texts = ["no roughness below", f"{_PLATEAU:g} C"]
    if str(psd.attrs.get("rolloff", "")).startswith("not reached"):
        # the spectrum still rises where it was last seen: the power law may go on
        hurst = float(psd.attrs["hurst_exponent"])
        more = (q[guessed] / first) ** (-2 * (1 + hurst))
        reason = "a plateau is assumed there; without it, and with the power law in its place"
        texts[1] = "power law"
    raised = c.copy()
    raised[guessed] *= more
    return Variation(
        name,
        reason,
        (f"{texts[0]} {first:.3g} 1/m", f"{texts[1]} below {first:.3g} 1/m"),
        ({"psd": band(psd[["psd_2d"]], first, q[-1])}, {"psd": _spectrum(q, raised)}),
    )


def hurst_exponent(base: Base) -> Variation | Skipped:
    """Tilt what was extrapolated to large wavenumbers about the last measured one."""
    psd = base.spectrum
    q, c = spectrum_arrays(psd)
    last = _measured_to(base)
    if last is None:
        return Skipped("Hurst exponent", _NO_TAIL)
    fitted = float(psd.attrs.get("hurst_exponent_standard_error", 0.0))
    error = max(_HURST, _NORMAL * fitted)
    hurst = psd.attrs.get("hurst_exponent", _local_exponent(q, c))
    tilt = np.maximum(q / last, 1.0)
    low, high = (_spectrum(q, c * tilt ** (-2 * d)) for d in (-error, error))
    return Variation(
        "Hurst exponent",
        f"of the part above {last:.3g} 1/m; at least {_HURST:g}, as a spectrum need not be one "
        "power law over the decades that were not measured, or 1.96 standard errors of the fit",
        (f"H = {hurst - error:.3g}", f"H = {hurst + error:.3g}"),
        ({"psd": low}, {"psd": high}),
    )


def short_waves(base: Base) -> Variation | Skipped:
    """End the spectrum at longer waves, or carry it on to the size of an atom."""
    psd, name = base.spectrum, "spectrum at short waves"
    q, c = spectrum_arrays(psd)
    last = _measured_to(base)
    if last is None:
        return Skipped(name, _NO_TAIL)
    cut = max(last, q[-1] / _COARSER)
    atom = np.pi / _ATOM
    longer: Changed | None = None
    if q[-1] < atom and np.all(c[-2:] > 0):
        beyond = np.geomspace(q[-1], atom, 11)[1:]
        tail = c[-1] * (beyond / q[-1]) ** (-2 * (1 + _local_exponent(q, c)))
        longer = {"psd": _spectrum(np.append(q, beyond), np.append(c, tail))}
    shorter: Changed | None = {"psd": band(psd[["psd_2d"]], q[0], cut)} if cut < q[-1] else None
    return Variation(
        name,
        "where the shortest waves that matter are is a convention: ten times longer, and an atom",
        (f"q1 = {cut:.3g} 1/m" if shorter else "", f"q1 = {atom:.3g} 1/m" if longer else ""),
        (shorter, longer),
    )


def percolation(base: Base) -> Variation:
    """Vary the contact area at which the last channel closes."""
    ends = [_factors(base, percolation=value) for value in (_OPEN, _SHUT)]
    return Variation(
        "percolation threshold",
        "0.415 to 0.42 by numerics on large isotropic surfaces, less beside grooves; 0.5 in "
        "effective-medium theory of two equal phases",
        (f"A/A0 = {_OPEN:.2f}", f"A/A0 = {_SHUT:.2f}"),
        (ends[0], ends[1]),
    )


def shear_cutoff(base: Base) -> Variation:
    """Vary the gap under which fluid is not sheared as a continuum."""
    low, high = (_factors(base, cutoff=value) for value in _CUTOFFS)
    return Variation(
        "cut-off of <1/u>",
        f"a molecule to a few; {1e9 * CUTOFF:g} nm is the default",
        (f"{1e9 * _CUTOFFS[0]:g} nm", f"{1e9 * _CUTOFFS[1]:g} nm"),
        (low, high),
    )


def energy_factor(base: Base) -> Variation | Skipped:
    """Vary the elastic-energy factor of the mean separation."""
    if base.gamma == _GAMMA:
        return Skipped("elastic-energy factor", f"it is {_GAMMA:g} already")
    return Variation(
        "elastic-energy factor",
        "gamma: 0.45 by simulations at small pressure, 0.5 in the first theory",
        ("", f"gamma = {_GAMMA:g}"),
        (None, {"gamma": _GAMMA, **_factors(base, gamma=_GAMMA)}),
    )


def area_theory(base: Base) -> Variation:
    """Take the other theory of the contact area: Persson's, or the corrected one."""
    plain, other = base.area == "persson", other_area(base.area)
    return Variation(
        "theory of the contact area",
        "Persson's lies 14 to 31 % under boundary elements where contact is light, the corrected "
        "one within 5 % of them",
        ("", "corrected") if plain else ("Persson's", ""),
        (None, {"area": other}) if plain else ({"area": other}, None),
    )


def work_of_adhesion(base: Base) -> Variation | Skipped:
    """Vary the work of adhesion under the liquid over the range that is stated."""
    name = "work of adhesion"
    if base.work_of_adhesion_range is None:
        return Skipped(name, "no work_of_adhesion_range was given")
    low, high = base.work_of_adhesion_range
    return Variation(
        name,
        "as stated; it hangs on surface energies and contact angles, which differ between sources",
        (f"{1e3 * low:.3g} mJ/m²", f"{1e3 * high:.3g} mJ/m²"),
        ({"work_of_adhesion": low}, {"work_of_adhesion": high}),
    )


def rough_body(base: Base) -> Variation:
    """Take the other body as the rough one: phi_s changes sign."""
    other: RoughBody = "moving" if base.rough_body == "stationary" else "stationary"
    return Variation(
        "rough body",
        "which of the two is rough sets the sign of phi_s, and papers differ",
        ("", f"{other} body is rough"),
        (None, {"rough_body": other}),
    )


def friction_factors(base: Base) -> Variation:
    """Switch the friction factors of Eq. (4) off, or on."""
    return Variation(
        "friction factors",
        "how roughness changes the shear of the liquid (φ_f, φ_fs and φ_fp in Eq. (4) of Xu et "
        "al., 2026) is often left out",
        ("off", "") if base.friction_factors else ("", "on"),
        ({"friction_factors": False}, None)
        if base.friction_factors
        else (None, {"friction_factors": True}),
    )


def viscosity(base: Base) -> Variation | Skipped:
    """Vary the liquid's viscosity over the range that is stated."""
    if base.viscosity_range is None:
        return Skipped("viscosity", "no viscosity_range was given")
    low, high = base.viscosity_range
    return Variation(
        "viscosity",
        "as stated; that of a liquid hangs on temperature and on the water it takes up",
        (f"{low:.3g} Pa s", f"{high:.3g} Pa s"),
        ({"viscosity": low}, {"viscosity": high}),
    )


def youngs_modulus(base: Base) -> Variation | Skipped:
    """Vary Young's modulus over the range that is stated."""
    if base.youngs_modulus_range is None:
        return Skipped("Young's modulus", "no youngs_modulus_range was given")
    low, high = base.youngs_modulus_range
    return Variation(
        "Young's modulus",
        "as stated; that of an elastomer hangs on batch, cure, age and frequency",
        (f"{low / 1e6:.3g} MPa", f"{high / 1e6:.3g} MPa"),
        (
            {"contact": replace(base.contact, youngs_modulus=low)},
            {"contact": replace(base.contact, youngs_modulus=high)},
        ),
    )


def load(base: Base) -> Variation | Skipped:
    """Vary the load that the model takes over the range that is stated."""
    if base.load_range is None:
        return Skipped("load", "no load_range was given")
    low, high = base.load_range
    return Variation(
        "load",
        "as stated; it hangs on the force cell and on the length that carries it",
        (f"{low:.4g} N/m", f"{high:.4g} N/m"),
        ({"load": low}, {"load": high}),
    )


def radius(base: Base) -> Variation | Skipped:
    """Vary the cylinder's radius over the range that is stated."""
    if base.radius_range is None:
        return Skipped("radius", "no radius_range was given")
    low, high = base.radius_range
    return Variation(
        "radius",
        "as stated; of a ground or cast cylinder it is that near the contact",
        (f"{1e3 * low:.4g} mm", f"{1e3 * high:.4g} mm"),
        (
            {"contact": replace(base.contact, radius=low)},
            {"contact": replace(base.contact, radius=high)},
        ),
    )


def inlet_length(base: Base) -> Variation | Skipped:
    """Let the liquid begin where a cylinder ends, and its gap is no parabola any more."""
    name = "inlet length"
    if np.isfinite(base.inlet_length):
        return Skipped(name, "it is stated")
    stiffness, psd = base.contact.effective_modulus, base.psd
    table = None if psd is None else separation_table(psd, stiffness, base.gamma)
    radius = base.contact.radius
    if not radius > SHORTEST * half_width(base.contact, table, base.load):
        return Skipped(name, "the contact is as wide as the cylinder")
    return Variation(
        name,
        "where the liquid begins before the contact: at the cylinder's radius, or anywhere beyond",
        (f"{1e3 * radius:.3g} mm", ""),
        ({"inlet_length": radius}, None),
    )


OF_ROUGHNESS: tuple[Callable[[Base], Variation | Skipped], ...] = (
    spectrum_band,
    long_waves,
    hurst_exponent,
    short_waves,
    percolation,
    shear_cutoff,
    energy_factor,
    area_theory,
    rough_body,
    friction_factors,
)

OF_ANY: tuple[Callable[[Base], Variation | Skipped], ...] = (
    viscosity,
    youngs_modulus,
    load,
    radius,
    inlet_length,
)

_NO_TAIL = (
    "no part of the spectrum is marked as extrapolated to large wavenumbers (variable 'origin'); "
    "give measured_to"
)


def variations(base: Base) -> list[Variation | Skipped]:
    """Return all that can be varied in a model, and what cannot with the reason."""
    rough = [] if base.psd is None else [make(base) for make in OF_ROUGHNESS]
    if rough and base.work_of_adhesion is not None:
        rough.append(work_of_adhesion(base))
    return [*rough, *(make(base) for make in OF_ANY)]


def held_fixed(base: Base) -> list[Skipped]:
    """Return what no variation reaches."""
    fixed = dict(FIXED if base.psd is None else FIXED + FIXED_IF_ROUGH)
    if base.psd is not None and base.work_of_adhesion is not None:
        fixed["contact area"] = WITH_ADHESION
    return [Skipped(name, reason) for name, reason in fixed.items()]


def _factors(base: Base, **changed: float) -> Changed:
    given = {"percolation": PERCOLATION, "gamma": base.gamma, **changed}
    return {"factors": flow_factors(base.spectrum, base.rough_body, **given)}


def _origin(psd: xr.Dataset) -> np.ndarray:
    if "origin" in psd:
        return psd["origin"].values
    return np.full(psd.sizes["wavenumber"], MEASURED)


def _measured_to(base: Base) -> float | None:
    """Largest wavenumber that was measured, if there is more of the spectrum beyond it."""
    q, _ = spectrum_arrays(base.spectrum)
    if base.measured_to is not None:
        if not q[0] < base.measured_to < q[-1]:
            raise AnalysisError(
                f"{base.measured_to:.4g} 1/m lies outside the spectrum, which reaches "
                f"from {q[0]:.4g} to {q[-1]:.4g} 1/m",
                function="measured_to",
            )
        return base.measured_to
    guessed = _origin(base.spectrum) == TO_LARGE
    return float(q[~guessed][-1]) if guessed.any() and not guessed.all() else None


def _local_exponent(q: np.ndarray, c: np.ndarray) -> float:
    """Hurst exponent of the power law that the spectrum ends with; NaN if it is no power law."""
    rough = np.flatnonzero(c)[-2:]
    if rough.size < 2:
        return np.nan
    q, c = q[rough], c[rough]
    return float(-np.log(c[-1] / c[-2]) / np.log(q[-1] / q[-2]) / 2 - 1)


def _spectrum(q: np.ndarray, c: np.ndarray) -> xr.Dataset:
    return xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
