"""Contact area of a rough surface against reduced pressure, in three theories.

In Persson's theory the stress diffuses as in complete contact. In partial contact a wave stores
only a share S(P) of that elastic energy, and the variance of the stress grows more slowly: dV/dV_c
= S(P), V_c being that of complete contact. The share depends only on the area P, so that the area
is one function of y = sqrt(2) p/(E* xi) for all spectra.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import erf

from tribolab.core.errors import AnalysisError, nearest, shown

AreaTheory = Literal["persson", "corrected", "numerics"]
_GAMMA = 0.51  # S(0) in the corrected theory
_FIT = 0.5, 0.45  # a, b of the fitted theory, S = 1 - a (1 - P)^b
_FIRST, _LAST, _NODES = 6.0, 1e-6, 401  # table of z, with A/A0 = erf z: limits and number of nodes
_SHARES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "corrected": lambda area: _GAMMA + (1 - _GAMMA) * area**2,
    "numerics": lambda area: 1 - _FIT[0] * (1 - area) ** _FIT[1],
}


def area_of(reduced: np.ndarray, area: AreaTheory) -> np.ndarray:
    """Return A/A0 at reduced pressures y = p/(E* (pi int q^3 C dq)^(1/2)) of at least 0.

    Raises
    ------
    AnalysisError
        If the theory is unknown.

    Notes
    -----
    With w = V/p^2 and z = (2 w)^(-1/2): ``1/(2 y^2) = int_0^w dw'/S(erf z(w'))``, ``A/A0 = erf z``.
    ``"persson"`` has S = 1, so z = y; ``"corrected"`` S = 0.51 + 0.49 P^2, in the form of [1]_;
    ``"numerics"`` S = 1 - 0.5 (1 - P)^0.45, fitted to boundary elements. At small pressure
    A/A0 = 2/sqrt(pi) y/sqrt(S(0)).

    References
    ----------
    .. [1] C. Yang, B. N. J. Persson, J. Phys.: Condens. Matter 20, 215214 (2008).
       doi:10.1088/0953-8984/20/21/215214
    """
    check_area(area)
    if area == "persson":
        return erf(reduced)
    curve, lowest = _table(area)
    with np.errstate(divide="ignore"):
        log_y = np.log(reduced)
    inside = np.clip(log_y, lowest, np.log(_FIRST))
    return erf(np.exp(curve(inside) + log_y - inside))


def check_area(area: str) -> None:
    """Raise an error unless the argument names one of the theories of the contact area."""
    known = list(get_args(AreaTheory))
    if area not in known:
        raise AnalysisError(f"area: '{shown(area)}' is not one{nearest(area, known)}")


def alternative_area_theory(area: AreaTheory) -> AreaTheory:
    """Return the theory to compare with: Persson's, or the corrected one if Persson's is used."""
    return "corrected" if area == "persson" else "persson"


@functools.cache
def _table(area: AreaTheory) -> tuple[PchipInterpolator, float]:
    """Return ln z against ln y, and the lowest ln y; above y = 6 contact is complete and z = y."""
    nodes = np.linspace(np.log(_FIRST), np.log(_LAST), _NODES)
    t, weight = np.polynomial.legendre.leggauss(6)
    half = (nodes[0] - nodes[1]) / 2
    z = np.exp(nodes[:-1, None] - half * (1 + t))
    # substitution dw = -d(ln z)/z^2
    pieces = half * (1 / (z**2 * _SHARES[area](erf(z)))) @ weight
    grown = 1 / (2 * _FIRST**2) + np.append(0.0, np.cumsum(pieces))
    log_y = -np.log(2 * grown) / 2
    return PchipInterpolator(log_y[::-1], nodes[::-1]), float(log_y[-1])
