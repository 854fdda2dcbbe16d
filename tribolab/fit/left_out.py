"""Effects neglected by a mixed-lubrication model, with their possible size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure
from tribolab.fit import limits
from tribolab.fit.variation import Base, Skipped
from tribolab.surface.moments import rms_roughness

_SHEET_THICKNESSES = (10e-3, 5e-3)  # m, of usual rubber sheets


def left_out(base: Base) -> list[Skipped]:
    """Return effects that are neither varied nor modelled, with their size if it can be estimated.

    Parameters
    ----------
    base
        The model.
    """
    contact, load = base.contact, base.load
    a = float(hertz_half_width(load, contact))
    found = []
    if contact.thickness == np.inf:
        found.append(Skipped("thickness", _layer_text(base, a)))
    if not contact.is_round:
        depth = a**2 / contact.radius
        tilt = limits.LOAD_CHANGE_BY_TILT.value * depth / (contact.force(1.0) / 2)
        found.append(
            Skipped(
                "crown, edge load and misalignment",
                "not in the model, which is a long cylinder parallel to the flat: a tilt of "
                f"{1e3 * tilt:.2g} mrad changes the load at the ends by about "
                f"{limits.LOAD_CHANGE_BY_TILT.value:.0%}",
            )
        )
    if base.psd is not None:
        height = rms_roughness(base.psd)
        time = _squeezing_time(base, a, height)
        found += [
            Skipped(
                "squeeze-out",
                "not in the model, which is steady: after loading or reversal the film between "
                f"smooth bodies takes about {time:.2g} s to thin to h_rms",
            ),
            Skipped(
                "lay",
                "not in the model, whose roughness is isotropic: grooves along the sliding "
                "direction let liquid out, and grooves across it carry liquid in",
            ),
            Skipped(
                "hysteresis of the contact angle",
                "not in the model: wetting and dewetting have one work of adhesion",
            ),
        ]
    return found


def _layer_text(base: Base, a: float) -> str:
    peak = float(hertz_max_pressure(base.load, base.contact))
    parts = []
    for thickness in _SHEET_THICKNESSES:
        layer = replace(base.contact, thickness=thickness)
        width = float(hertz_half_width(base.load, layer)) / a - 1
        pressure = float(hertz_max_pressure(base.load, layer)) / peak - 1
        parts.append(
            f"{1e3 * thickness:g} mm would change the contact's width by {width:+.0%} and its "
            f"highest pressure by {pressure:+.0%}"
        )
    return "a half-space, as no thickness was given: " + ", ".join(parts)


def _squeezing_time(base: Base, a: float, height: float) -> float:
    """Return the time [s] in which the film under a flat punch thins to a height [m].

    Notes
    -----
    ``3 pi eta a^4/(4 F h^2)`` for a disk, ``4 eta a^3/(W h^2)`` for a strip of width 2 a.
    """
    if base.contact.is_round:
        return 3 * np.pi * base.viscosity * a**4 / (4 * base.load * height**2)
    return 4 * base.viscosity * a**3 / (base.load * height**2)
