"""Smooth line contacts: Hertz without adhesion, JKR with it."""

from __future__ import annotations

from typing import overload

import numpy as np
from numpy.typing import ArrayLike

from tribolab.contact.geometry import LineContact
from tribolab.errors import AnalysisError
from tribolab.units import to_si
from tribolab.validity import examine


def hertz_half_width(load: str | ArrayLike, contact: LineContact) -> np.ndarray | float:
    """Half-width a of a Hertz line contact.

    Parameters
    ----------
    load
        F_N/L [N/m] (any dims), not negative; text with a unit if scalar.
    contact
        Geometry and elasticity.

    Returns
    -------
    float or numpy.ndarray
        a [m], with the shape of `load`.

    Raises
    ------
    AnalysisError
        If a load is negative, or the contact wider than its cylinder (`tribolab.validity`).

    Notes
    -----
    ``a = sqrt(4 R F / (pi E* L))``, Eq. (16) of [1]_. Section 5 of [1]_ prints 37 mm for what
    Eq. (16) makes 3.7 mm; its own Appendix B has the width 2a = 7.43 mm.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{2e3 * hertz_half_width('310 N/m', contact):.2f} mm"
    '7.43 mm'
    """
    force = _loads(load)
    if np.any(force < 0):
        raise AnalysisError(
            f"load: without adhesion a contact cannot be pulled; got {np.min(force):g} N/m"
        )
    half_width = np.sqrt(4 * contact.radius * force / (np.pi * contact.effective_modulus))[()]
    examine("hertz_half_width", half_width=half_width / contact.radius)
    return half_width


def hertz_max_pressure(load: str | ArrayLike, contact: LineContact) -> np.ndarray | float:
    """Maximum pressure [Pa] of a Hertz line contact, ``2 F / (pi a L)``; zero without load."""
    return 4 / np.pi * hertz_mean_pressure(load, contact)


def hertz_mean_pressure(load: str | ArrayLike, contact: LineContact) -> np.ndarray | float:
    """Mean pressure [Pa] of a Hertz line contact, ``F / (2 a L)``: the nominal pressure.

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> hertz_mean_pressure([310.0, 2110.0], contact).round(-2)
    array([ 41700., 108800.])
    """
    # F/(2a) with F put in terms of a, so that no load gives 0 and not 0/0
    a = hertz_half_width(load, contact)
    return np.pi * contact.effective_modulus * a / (8 * contact.radius)


@overload
def hertz_pressure(x: np.ndarray, load: str | float, contact: LineContact) -> np.ndarray: ...


@overload
def hertz_pressure(x: ArrayLike, load: str | float, contact: LineContact) -> np.ndarray | float: ...


def hertz_pressure(x: ArrayLike, load: str | float, contact: LineContact) -> np.ndarray | float:
    """Pressure [Pa] of a Hertz line contact at x [m] (any dims) from its middle; 0 outside."""
    a = hertz_half_width(load, contact)
    inside = np.maximum(a**2 - np.asarray(x, dtype=float) ** 2, 0)
    return (contact.effective_modulus / (2 * contact.radius) * np.sqrt(inside))[()]


def jkr_smallest_load(contact: LineContact, work_of_adhesion: str | float) -> float:
    """Smallest load [N/m] at which an adhesive line contact holds; negative: a pull.

    Parameters
    ----------
    contact
        Geometry and elasticity.
    work_of_adhesion
        Macroscopic work of adhesion w [J/m2], not negative.

    Notes
    -----
    The minimum of Eq. (15), ``-(3/4) sqrt(2 pi E* w a)`` at ``a = (2 R^2 w / (pi E*))^(1/3)``.

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{jkr_smallest_load(contact, '64 mJ/m^2'):.2f} N/m"
    '-14.49 N/m'
    """
    w = _work(work_of_adhesion)
    return float(
        -0.75 * np.sqrt(2 * np.pi * contact.effective_modulus * w * _detaching(contact, w))
    )


def jkr_half_width(
    load: str | ArrayLike, contact: LineContact, work_of_adhesion: str | float
) -> np.ndarray | float:
    """Half-width a of an adhesive (JKR) line contact, on the branch that goes over into Hertz.

    Parameters
    ----------
    load
        F_N/L [N/m] (any dims), negative when pulled; text with a unit if scalar.
    contact
        Geometry and elasticity.
    work_of_adhesion
        Macroscopic work of adhesion w [J/m2], not negative; 0 gives Hertz.

    Returns
    -------
    float or numpy.ndarray
        a [m], with the shape of `load`.

    Raises
    ------
    AnalysisError
        If a load is below the smallest one that has a solution; the message gives that load.

    Notes
    -----
    Eq. (15) of [1]_, ``F/L = pi E* a^2/(4R) - sqrt(2 pi E* a w)``. With a = a_m b^2, a_m the
    half-width at the smallest load, it reads ``b^4 - 4 b = -3 F/F_min``, convex for b > 1, so that
    Newton's method from above cannot miss.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{1e3 * jkr_half_width('310 N/m', contact, '64 mJ/m^2'):.2f} mm"
    '4.04 mm'
    """
    w = _work(work_of_adhesion)
    if w == 0:
        return hertz_half_width(load, contact)
    force = _loads(load)
    smallest = jkr_smallest_load(contact, w)
    if np.any(force < smallest * (1 + 1e-12)):
        raise AnalysisError(
            f"load: an adhesive contact with w = {w:g} J/m2 detaches below {smallest:.6g} N/m; "
            f"got {np.min(force):.6g} N/m"
        )
    phi = np.maximum(3 * force / -smallest, -3.0)
    b = np.maximum(phi, 0.0) ** 0.25 + 4 ** (1 / 3)
    for _ in range(80):  # quadratic, but linear with rate 1/2 at the smallest load itself
        steep = np.maximum(4 * (b**3 - 1), np.finfo(float).tiny)
        b, before = np.maximum(b - (b**4 - 4 * b - phi) / steep, 1.0), b
        if np.allclose(b, before, rtol=1e-15, atol=0):
            break
    half_width = (_detaching(contact, w) * b**2)[()]
    examine("jkr_half_width", half_width=half_width / contact.radius)
    return half_width


def _detaching(contact: LineContact, w: float) -> float:
    """Half-width at the smallest load, where Eq. (15) has its minimum."""
    return (2 * contact.radius**2 * w / (np.pi * contact.effective_modulus)) ** (1 / 3)


def _work(work_of_adhesion: str | float) -> float:
    w = to_si(work_of_adhesion, "J/m2", name="work_of_adhesion")
    if not 0 <= w < np.inf:
        raise AnalysisError(f"work_of_adhesion: it must be finite and not negative; got {w:g} J/m2")
    return w


def _loads(load: str | ArrayLike) -> np.ndarray:
    number = to_si(load, "N/m", name="load") if isinstance(load, str) else load
    force = np.asarray(number, dtype=float)
    if not np.all(np.isfinite(force)):
        raise AnalysisError("load: every load must be a finite number in N/m")
    return force
