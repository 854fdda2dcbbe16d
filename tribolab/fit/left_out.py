"""Effects that a mixed-lubrication model neglects, each with its size and the reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.contact.geometry import Contact, LineContact
from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure
from tribolab.core.wording import percent
from tribolab.fit import limits
from tribolab.surface.moments import rms_roughness

_SHEET_THICKNESSES = (10e-3, 5e-3)  # typical rubber sheets [m]


class LeftOut(NamedTuple):
    """An effect that the model neglects."""

    name: str
    size: str  # empty if it cannot be estimated
    why: str


def effects_not_modelled(
    contact: Contact, load: float, viscosity: float, psd: xr.Dataset | None
) -> list[LeftOut]:
    """Return the effects that are neither modelled nor varied, with their size if it is known.

    Parameters
    ----------
    contact, load, psd
        The contact, its load [N/m; N for a ball] and the spectrum; None for smooth surfaces.
    viscosity
        Zero-shear viscosity [Pa s].

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> [effect.name for effect in effects_not_modelled(contact, 310.0, 1.4, None)]
    ['thickness', 'edge load', 'misalignment', 'crown']
    """
    a = float(hertz_half_width(load, contact))
    found = []
    if contact.thickness == np.inf:
        text = "the elastomer is a half-space, as no thickness is stated"
        found.append(LeftOut("thickness", _effect_of_thickness(contact, load, a), text))
    if isinstance(contact, LineContact):
        found += _ends(contact, a)
    if psd is None:
        return found
    time = _squeezing_time(contact, load, viscosity, a, rms_roughness(psd))
    size = f"{time:.2g} s until the film between smooth bodies thins to h_rms"
    wetting = "wetting and dewetting have one work of adhesion"
    lay = "roughness is isotropic; grooves along the motion let liquid out, across it carry it in"
    return [
        *found,
        LeftOut("squeeze-out time", size, "speeds are steady: no loading, no reversal"),
        LeftOut("lay", "", lay),
        LeftOut("contact angle hysteresis", "", wetting),
    ]


def describe_effects(effects: Sequence[LeftOut]) -> str:
    """Return the neglected effects and their sizes as text."""
    return "; ".join(f"{e.name} ({e.size or 'size unknown'}): {e.why}" for e in effects)


def _ends(contact: LineContact, a: float) -> list[LeftOut]:
    """Return the effects of the ends of a cylinder.

    Notes
    -----
    At a distance s from the middle of a slender contact of length L, the load per length w indents
    the half-space by ``(w/(pi E*)) [ln(16 (L^2/4 - s^2)/a^2) + 1]``. The indentation by a straight
    cylinder is the same everywhere, so w is larger near the ends, where the bracket is smaller:
    by 27 % in a contact of 100 mm x 7.4 mm, 35 % if solved along the length. For a load that
    varies linearly the bracket is smaller by 2, and by 1 more because a^2 increases with w; the
    mean over s, weighted by s^2, is smaller than that in the middle by 8/3 - 2 ln 2. A layer limits
    how far the indentation reaches.
    """
    reach = min(contact.length, contact.thickness)
    middle = 2 * np.log(2 * reach / a) + 1
    change = limits.LOAD_CHANGE_BY_TILT.value
    linear = max(middle - 3 - (8 / 3 - 2 * np.log(2)), 1.0)
    drop = change * linear * a**2 / (4 * contact.radius)
    edge = LeftOut(
        "edge load",
        f"load per length some {_round(middle / (np.log(16 * reach / a) + 1) - 1)} higher "
        f"{1e3 * a:.2g} mm from the ends",
        "the cylinder is infinitely long; the flat extends beyond its ends",
    )
    tilt = LeftOut(
        "misalignment",
        f"a tilt of {2e3 * drop / contact.length:.2g} mrad changes the load per length at the "
        f"ends by {percent(change)}",
        "the cylinder is parallel to the flat",
    )
    crown = LeftOut(
        "crown",
        f"a drop of {1e6 * drop:.2g} µm at the ends lowers the load per length there by some "
        f"{percent(change)}",
        "the cylinder is straight",
    )
    return [edge, tilt, crown]


def _round(share: float) -> str:
    return percent(float(f"{share:.1g}"))


def _signed(share: float) -> str:
    return f"{'+' * (share > 0)}{percent(round(share, 2))}"


def _effect_of_thickness(contact: Contact, load: float, a: float) -> str:
    peak = float(hertz_max_pressure(load, contact))
    parts = []
    for thickness in _SHEET_THICKNESSES:
        layer = replace(contact, thickness=thickness)
        width = float(hertz_half_width(load, layer)) / a - 1
        pressure = float(hertz_max_pressure(load, layer)) / peak - 1
        parts.append(
            f"{1e3 * thickness:g} mm would change the contact's width by {_signed(width)} and "
            f"its highest pressure by {_signed(pressure)}"
        )
    return ", ".join(parts)


def _squeezing_time(
    contact: Contact, load: float, viscosity: float, a: float, height: float
) -> float:
    """Return the time [s] in which the film under a flat punch thins to a height [m].

    Notes
    -----
    ``3 pi eta a^4/(4 F h^2)`` for a disk, ``4 eta a^3/(W h^2)`` for a strip of width 2 a.
    """
    if contact.is_round:
        return 3 * np.pi * viscosity * a**4 / (4 * load * height**2)
    return 4 * viscosity * a**3 / (load * height**2)
