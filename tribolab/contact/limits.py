"""Validity limits of contact theory for line and point contacts, see `tribolab.core.validity`."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.geometry import Contact
from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure
from tribolab.contact.separation import Separation
from tribolab.core.validity import LIMITS, examine, together
from tribolab.surface.moments import rms_slope

_PIEZOVISCOSITY = 2e-8  # 1/Pa, d ln(viscosity)/dp of mineral oils; three times that of glycerol


def line_limits(
    who: str,
    contact: Contact,
    load: ArrayLike,
    psd: xr.Dataset | None = None,
    separation: Separation | None = None,
    speed: ArrayLike = (),
    film: ArrayLike = (),
) -> dict[str, str]:
    """Return the attributes ``validity`` and ``validity_reasons`` for a contact.

    Parameters
    ----------
    who
        Name of the calling function, for its error.
    contact, load, psd
        The contact, its loads F_N/L [N/m] or F_N [N], and the spectrum if it is rough.
    separation
        Table of p(u), whose range the pressure should not exceed.
    speed, film
        Sliding speeds [m/s] and their film thicknesses [m] (speed, ...).

    Raises
    ------
    AnalysisError
        If the contact exceeds a limit beyond which the theory is invalid.

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> soft = LineContact("7 mm", "10 cm", "0.1 MPa", 0.5)
    >>> line_limits("curve", soft, 310.0)["validity"]
    'suspect'
    """
    loads = np.atleast_1d(np.asarray(load, dtype=float))
    loads = loads[loads > 0]
    if not loads.size:
        return together([])
    largest = float(loads.max())
    compared = [
        examine(
            who,
            f"at {largest:.3g} {contact.load_unit}",
            half_width=hertz_half_width(largest, contact) / contact.radius,
            pressure=np.nan
            if separation is None
            else hertz_max_pressure(largest, contact) / separation.table_pressure[-1],
        )
    ]
    if psd is not None:
        compared.append(examine(who, slope=rms_slope(psd)))
    if np.size(film):
        speeds, films = np.abs(np.asarray(speed, dtype=float)), np.asarray(film, dtype=float)
        thick = films.reshape(speeds.size, -1).max(axis=1) / contact.radius
        peak = float(hertz_max_pressure(largest, contact))
        compared.append(
            examine(
                who,
                f"({1e-6 * peak:.3g} MPa at {largest:.3g} {contact.load_unit})",
                thickening=_PIEZOVISCOSITY * peak,
            )
        )
        beyond = speeds[thick > LIMITS["film"].suspect]
        where = f"(above the limit from {beyond.min():.3g} m/s on)" if beyond.size else ""
        compared.append(examine(who, where, film=thick))
    return together(compared)
