"""Increase of the contact area by adhesion, tabulated against pressure."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.contact.adhesive_contact import adhesion
from tribolab.contact.line import WIDTH_LEVEL
from tribolab.units.conversion import to_si

_POINTS = 21  # number of pressures in the table


class AdhesiveGrowth(NamedTuple):
    """Ratio of the contact areas with and without adhesion, tabulated against pressure.

    Parameters
    ----------
    log_pressure
        ln p, p in Pa (n).
    log_growth
        ln of the ratio of the areas (n).
    work_of_adhesion
        [J/m2]
    """

    log_pressure: np.ndarray
    log_growth: np.ndarray
    work_of_adhesion: float

    def __call__(self, solid: np.ndarray, whole: np.ndarray, area: np.ndarray) -> np.ndarray:
        """Return the contact area with adhesion, given the area without adhesion.

        Parameters
        ----------
        solid, whole
            Pressure of the solid contact, and of solid plus fluid [Pa] (..., x).
        area
            A/A0 at the solid pressure without adhesion [1] (..., x).

        Notes
        -----
        ``A(p_cont) A_adh(p)/A_0(p)``, at most 1: adhesion acts in the solid share of the contact.
        In the linear range this is A_adh(p_cont); for a contact that adheres without pressure it
        still vanishes with p_cont. Outside the nominal contact, where p is below 1e-3 of its
        maximum, adhesion is neglected.
        """
        with np.errstate(divide="ignore"):  # tension in a flooded outlet, outside the contact
            pressure = np.log(np.maximum(whole, 0.0))
            growth = np.exp(np.interp(pressure, self.log_pressure, self.log_growth))
        nominal = whole > WIDTH_LEVEL * whole.max(axis=-1, keepdims=True)
        return np.where(nominal & (solid > 0), np.minimum(area * growth, 1.0), area)


def adhesive_growth(
    psd: xr.Dataset, effective_modulus: float, work_of_adhesion: str | float, highest: float
) -> AdhesiveGrowth | None:
    """Return a table of the ratio of contact areas with and without adhesion, by pressure.

    Parameters
    ----------
    psd, effective_modulus
        As for `adhesion`.
    work_of_adhesion
        Work of adhesion in the liquid [J/m2]; if not above zero, the liquid wets and the area is
        unchanged.
    highest
        Largest pressure [Pa] of the table.

    Returns
    -------
    AdhesiveGrowth or None
        None if the area is unchanged.

    Raises
    ------
    AnalysisError
        As for `adhesion`.
    """
    work = to_si(work_of_adhesion, "J/m^2", name="work_of_adhesion")
    if work <= 0:
        return None
    pressure = np.geomspace(WIDTH_LEVEL * highest / 2, highest, _POINTS)
    solved = adhesion(pressure, psd, effective_modulus, work)
    growth = solved["contact_area_ratio"] / solved["contact_area_ratio_no_adhesion"]
    return AdhesiveGrowth(np.log(pressure), np.log(growth.values), work)
