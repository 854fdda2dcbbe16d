"""Variations of a mixed-lubrication model, one unknown at a time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribolab.contact.area import alternative_area_theory
from tribolab.contact.separation import separation_table
from tribolab.fit.stated_ranges import (
    LOAD_RANGE,
    RADIUS_RANGE,
    VISCOSITY,
    WORK_OF_ADHESION,
    YOUNGS_MODULUS,
)
from tribolab.fit.theory_error import factors_of_numerics, pressure_of_numerics
from tribolab.fit.variation import Base, Changed, Skipped, Variation
from tribolab.fit.varied_spectrum import hurst_exponent, long_waves, short_waves, spectrum_band
from tribolab.lubrication.domain import SHORTEST, half_width
from tribolab.lubrication.factors import CUTOFF, PERCOLATION, RoughBody, flow_factors

_LOW_PERCOLATION, _HIGH_PERCOLATION = 0.40, 0.50
_LIQUID_RADII = 3.0  # largest extent of the liquid around a ball, in ball radii: some 30 mm
_FILM_CUTOFFS = 0.3e-9, 3e-9
_OTHER_GAMMA = 0.5
# unknowns that are never varied: for all surfaces, and for rough surfaces only
_FIXED = (
    ("liquid", "Newtonian and isothermal, its viscosity the same at every pressure and shear rate"),
    ("cavitation", "the liquid ruptures at one pressure, that outside or of its vapour"),
    ("elasticity", "linear and without loss"),
)
_FIXED_IF_ROUGH = (
    ("shear stress in the contact", "the same at every speed, load and temperature"),
    ("contact area", "without adhesion, at rest"),
    ("roughness", "Gaussian, isotropic and on one of the bodies"),
)

_WITH_ADHESION = "with adhesion in its mean field, at rest; films and pressures are without it"


def percolation(base: Base) -> Variation:
    """Vary the contact area ratio at which the last flow channel closes."""
    ends = [_factors(base, percolation=value) for value in (_LOW_PERCOLATION, _HIGH_PERCOLATION)]
    return Variation(
        "percolation threshold",
        "0.415 to 0.42 by numerics on large isotropic surfaces, less with grooves; 0.5 in "
        "effective-medium theory of two equal phases",
        (f"A/A0 = {_LOW_PERCOLATION:.2f}", f"A/A0 = {_HIGH_PERCOLATION:.2f}"),
        (ends[0], ends[1]),
    )


def shear_cutoff(base: Base) -> Variation:
    """Vary the smallest gap in which liquid is sheared as a continuum."""
    low, high = (_factors(base, cutoff=value) for value in _FILM_CUTOFFS)
    return Variation(
        "cut-off of <1/u>",
        f"a molecule to a few; {1e9 * CUTOFF:g} nm is the default",
        (f"{1e9 * _FILM_CUTOFFS[0]:g} nm", f"{1e9 * _FILM_CUTOFFS[1]:g} nm"),
        (low, high),
    )


def energy_factor(base: Base) -> Variation | Skipped:
    """Vary the elastic-energy factor gamma of the mean separation."""
    if base.gamma == _OTHER_GAMMA:
        return Skipped("elastic-energy factor", f"it is {_OTHER_GAMMA:g} already")
    return Variation(
        "elastic-energy factor",
        "gamma: 0.45 by simulations at small pressure, 0.5 in the first theory",
        ("", f"gamma = {_OTHER_GAMMA:g}"),
        (None, {"gamma": _OTHER_GAMMA, **_factors(base, gamma=_OTHER_GAMMA)}),
    )


def area_theory(base: Base) -> Variation:
    """Replace the theory of the contact area: Persson's by the corrected one, or vice versa."""
    plain, other = base.area == "persson", alternative_area_theory(base.area)
    return Variation(
        "theory of the contact area",
        "Persson's lies 14 to 31 % under boundary elements where contact is light, the corrected "
        "one within 5 % of them",
        ("", "corrected") if plain else ("Persson's", ""),
        (None, {"area": other}) if plain else ({"area": other}, None),
    )


def rough_body(base: Base) -> Variation:
    """Exchange the smooth and the rough body, which reverses the sign of phi_s."""
    other: RoughBody = "moving" if base.rough_body == "stationary" else "stationary"
    return Variation(
        "rough body",
        "which of the two is rough sets the sign of phi_s, and papers differ",
        ("", f"{other} body is rough"),
        (None, {"rough_body": other}),
    )


def friction_factors(base: Base) -> Variation:
    """Switch the friction factors of Eq. (4) off if they are on, or on if they are off."""
    return Variation(
        "friction factors",
        "how roughness changes the shear of the liquid (φ_f, φ_fs and φ_fp in Eq. (4) of Xu et "
        "al., 2026) is often left out",
        ("off", "") if base.friction_factors else ("", "on"),
        ({"friction_factors": False}, None)
        if base.friction_factors
        else (None, {"friction_factors": True}),
    )


def flow_and_shear_factors(base: Base) -> Variation:
    """Replace phi_f by numerical results, and all factors by their limit at large separation."""
    factors = flow_factors(base.spectrum, base.rough_body, gamma=base.gamma)
    return Variation(
        "flow and shear factors",
        "effective-medium theory: φ_f is 19 to 24 % above direct numerics at 2 to 3.2 h_rms; "
        "beyond 7 h_rms φ_p is 4 % and φ_fs up to 31 % off the limit of Gaussian gaps",
        ("", "as in numerics"),
        (None, {"factors": factors_of_numerics(factors)}),
    )


def contact_pressure(base: Base) -> Variation:
    """Increase the contact pressure at small separation to that of numerical results."""
    table = separation_table(base.spectrum, base.contact.effective_modulus, base.gamma)
    return Variation(
        "contact pressure p(u)",
        "8 to 17 % below boundary elements at separations below 0.14 h_rms",
        ("", "17 % higher below 0.14 h_rms"),
        (None, {"separation": pressure_of_numerics(table)}),
    )


def inlet_length(base: Base) -> Variation | Skipped:
    """Vary where the liquid begins before a cylinder, or how far it extends around a ball."""
    name = "inlet length"
    if np.isfinite(base.inlet_length):
        return Skipped(name, "it is stated")
    if base.contact.is_round:
        far = _LIQUID_RADII * base.contact.radius
        return Variation(
            "extent of the liquid",
            "the drag of a ball's liquid grows as the logarithm of where it ends: at the ball's "
            "radius, or at three times that",
            ("", f"{1e3 * far:.3g} mm"),
            (None, {"inlet_length": far}),
        )
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


def outlet(base: Base) -> Variation | Skipped:
    """Flood a vented outlet: without gas, the liquid there sustains tension."""
    if base.outlet != "unknown":
        return Skipped("outlet", "it is stated")
    return Variation(
        "outlet",
        "whether gas gets in behind the contact; films and friction differ as by another viscosity",
        ("", "flooded"),
        (None, {"outlet": "flooded"}),
    )


_OF_ROUGHNESS: tuple[Callable[[Base], Variation | Skipped], ...] = (
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
    flow_and_shear_factors,
    contact_pressure,
)

_OF_ANY: tuple[Callable[[Base], Variation | Skipped], ...] = (
    VISCOSITY,
    YOUNGS_MODULUS,
    LOAD_RANGE,
    RADIUS_RANGE,
    inlet_length,
    outlet,
)


def variations(base: Base) -> list[Variation | Skipped]:
    """Return all variations of a model, and unknowns that cannot be varied, with the reason."""
    rough = [] if base.psd is None else [make(base) for make in _OF_ROUGHNESS]
    if rough and base.work_of_adhesion is not None:
        rough.append(WORK_OF_ADHESION(base))
    return [*rough, *(make(base) for make in _OF_ANY)]


def fixed_parameters(base: Base) -> list[Skipped]:
    """Return the unknowns that are never varied."""
    fixed = {"geometry and load": _stated_text(base)}
    fixed |= dict(_FIXED if base.psd is None else _FIXED + _FIXED_IF_ROUGH)
    if base.psd is not None and base.work_of_adhesion is not None:
        fixed["contact area"] = _WITH_ADHESION
    return [Skipped(name, reason) for name, reason in fixed.items()]


def _stated_text(base: Base) -> str:
    """Return a text that names the geometry and load parameters without a stated range."""
    stated = {
        "radius": base.radius_range is None,
        "length": True,
        "Poisson's ratio": True,
        "normal force": base.load_range is None,
    }
    *before, last = [name for name, taken in stated.items() if taken]
    return f"{', '.join(before)} and {last} are taken as stated"


def _factors(base: Base, **changed: float) -> Changed:
    given = {"percolation": PERCOLATION, "gamma": base.gamma, **changed}
    return {"factors": flow_factors(base.spectrum, base.rough_body, **given)}
