"""Smooth line and point contacts: Hertz theory without adhesion, JKR theory with it."""

from __future__ import annotations

from typing import overload

import numpy as np
from numpy.typing import ArrayLike

from tribolab.contact.geometry import Contact
from tribolab.contact.layer import layer_contact
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import examine
from tribolab.units.conversion import to_si


def hertz_half_width(load: str | ArrayLike, contact: Contact) -> np.ndarray | float:
    """Return the half-width a of a Hertz line contact, or the contact radius a of a ball.

    Parameters
    ----------
    load
        F_N/L [N/m], for a ball F_N [N] (any dims), not negative; text with a unit if scalar.
    contact
        Geometry and elasticity.

    Returns
    -------
    float or numpy.ndarray
        a [m], with the shape of `load`.

    Raises
    ------
    AnalysisError
        If a load is negative, or the contact wider than its cylinder (`tribolab.core.validity`).

    Notes ----- ``a = sqrt(4 R F / (pi E* L))``, Eq. (16) of [1]_; for a ball ``(3 F R/(4
    E*))^(1/3)``. On a layer it is the half-width of a smooth contact with that layer
    (`tribolab.contact.layer`). Section 5 of [1]_ prints 37 mm, but Eq. (16) gives 3.7 mm, in
    agreement with the width 2a = 7.43 mm in its Appendix B.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{2e3 * hertz_half_width('310 N/m', contact):.2f} mm"
    '7.43 mm'
    """
    half_width = _smooth(load, contact)[0]
    examine("hertz_half_width", half_width=half_width / contact.radius)
    return half_width


def hertz_max_pressure(load: str | ArrayLike, contact: Contact) -> np.ndarray | float:
    """Return the maximum pressure [Pa], ``2 F/(pi a L)`` or ``3 F/(2 pi a^2)`` for a ball."""
    if contact.thickness < np.inf:
        return _smooth(load, contact)[1]
    return (1.5 if contact.is_round else 4 / np.pi) * hertz_mean_pressure(load, contact)


def hertz_mean_pressure(load: str | ArrayLike, contact: Contact) -> np.ndarray | float:
    """Return the mean pressure [Pa] of a Hertz contact: ``F/(2 a L)``, for a ball ``F/(pi a^2)``.

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> hertz_mean_pressure([310.0, 2110.0], contact).round(-2)
    array([ 41700., 108800.])
    """
    # expressed by a, so that zero load gives 0 and not 0/0
    a = hertz_half_width(load, contact)
    if contact.thickness < np.inf:
        force = _loads(load, contact)
        area = np.maximum(np.pi * a**2 if contact.is_round else 2 * a, np.finfo(float).tiny)
        return (force / area)[()]
    if contact.is_round:
        return 4 * contact.effective_modulus * a / (3 * np.pi * contact.radius)
    return np.pi * contact.effective_modulus * a / (8 * contact.radius)


def _smooth(
    load: str | ArrayLike, contact: Contact
) -> tuple[np.ndarray | float, np.ndarray | float]:
    """Return the half-width [m] of a smooth contact; for a layer, also its peak pressure [Pa]."""
    force = _loads(load, contact)
    if np.any(force < 0):
        raise AnalysisError(
            "load: without adhesion a contact cannot be pulled; got "
            f"{np.min(force):g} {contact.load_unit}"
        )
    if contact.is_round:
        half_width = np.cbrt(3 * contact.radius * force / (4 * contact.effective_modulus))[()]
    else:
        half_width = np.sqrt(4 * contact.radius * force / (np.pi * contact.effective_modulus))[()]
    layer = contact.layer(contact.radius)
    if layer is None:
        return half_width, np.nan
    scale = contact.effective_modulus * contact.radius ** (2 if contact.is_round else 1)
    found = [
        layer_contact(w / scale, layer, contact.is_round, a / contact.radius) if w else (0.0, 0.0)
        for w, a in zip(force.ravel(), np.ravel(half_width), strict=True)
    ]
    width, pressure = (np.reshape(part, force.shape)[()] for part in zip(*found, strict=True))
    return contact.radius * width, contact.effective_modulus * pressure


@overload
def hertz_pressure(x: np.ndarray, load: str | float, contact: Contact) -> np.ndarray: ...


@overload
def hertz_pressure(x: ArrayLike, load: str | float, contact: Contact) -> np.ndarray | float: ...


def hertz_pressure(x: ArrayLike, load: str | float, contact: Contact) -> np.ndarray | float:
    """Return the pressure [Pa] of a Hertz contact at a distance x [m] from its centre; 0 outside.

    On a layer it is approximated by a half ellipse with the same width and load.
    """
    a = hertz_half_width(load, contact)
    inside = np.maximum(a**2 - np.asarray(x, dtype=float) ** 2, 0)
    if contact.thickness < np.inf:
        peak = (1.5 if contact.is_round else 4 / np.pi) * hertz_mean_pressure(load, contact)
        return (peak / a * np.sqrt(inside))[()]
    steep = 2 / (np.pi * contact.radius) if contact.is_round else 1 / (2 * contact.radius)
    return (contact.effective_modulus * steep * np.sqrt(inside))[()]


def jkr_smallest_load(contact: Contact, work_of_adhesion: str | float) -> float:
    """Return the pull-off load [N/m] ([N] for a ball) of a JKR contact, zero or negative.

    Parameters
    ----------
    contact
        Geometry and elasticity.
    work_of_adhesion
        Macroscopic work of adhesion w [J/m2], not negative.

    Notes
    -----
    The minimum of Eq. (15), ``-(3/4) sqrt(2 pi E* w a)`` at ``a = (2 R^2 w / (pi E*))^(1/3)``; for
    a ball ``-1.5 pi w R``.

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{jkr_smallest_load(contact, '64 mJ/m^2'):.2f} N/m"
    '-14.49 N/m'
    """
    w = _checked_work(contact, work_of_adhesion)
    if contact.is_round:
        return -1.5 * np.pi * w * contact.radius
    return float(
        -0.75 * np.sqrt(2 * np.pi * contact.effective_modulus * w * _smallest_width(contact, w))
    )


def jkr_half_width(
    load: str | ArrayLike, contact: Contact, work_of_adhesion: str | float
) -> np.ndarray | float:
    """Return the half-width or radius a of a JKR contact, on the branch that tends to Hertz theory.

    Parameters
    ----------
    load
        F_N/L [N/m], for a ball F_N [N] (any dims), negative if pulled; text with a unit if scalar.
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
        If a load is below the smallest possible one; the message gives that load.

    Notes
    -----
    Eq. (15) of [1]_, ``F/L = pi E* a^2/(4R) - sqrt(2 pi E* a w)``. With a = a_m b^2, a_m the
    half-width at the smallest load, it becomes ``b^4 - 4 b = -3 F/F_min``, convex for b > 1, so
    that Newton's method from above always converges. For a ball
    ``a^3 = (3R/4E*) [F + 3 pi w R + sqrt(6 pi w R F + (3 pi w R)^2)]``.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> f"{1e3 * jkr_half_width('310 N/m', contact, '64 mJ/m^2'):.2f} mm"
    '4.04 mm'
    """
    w = _checked_work(contact, work_of_adhesion)
    if w == 0:
        return hertz_half_width(load, contact)
    force = _loads(load, contact)
    smallest = jkr_smallest_load(contact, w)
    if np.any(force < smallest * (1 + 1e-12)):
        raise AnalysisError(
            f"load: an adhesive contact with w = {w:g} J/m2 detaches below {smallest:.6g} "
            f"{contact.load_unit}; got {np.min(force):.6g} {contact.load_unit}"
        )
    if contact.is_round:
        pull = -2 * smallest  # magnitude of the pull-off force, 3 pi w R
        both = force + pull + np.sqrt(np.maximum(2 * pull * force + pull**2, 0.0))
        radius = np.cbrt(3 * contact.radius * both / (4 * contact.effective_modulus))[()]
        examine("jkr_half_width", half_width=radius / contact.radius)
        return radius
    phi = np.maximum(3 * force / -smallest, -3.0)
    b = np.maximum(phi, 0.0) ** 0.25 + 4 ** (1 / 3)
    for _ in range(80):  # quadratic convergence, except at the pull-off load (linear, rate 1/2)
        steep = np.maximum(4 * (b**3 - 1), np.finfo(float).tiny)
        b, before = np.maximum(b - (b**4 - 4 * b - phi) / steep, 1.0), b
        if np.allclose(b, before, rtol=1e-15, atol=0):
            break
    half_width = (_smallest_width(contact, w) * b**2)[()]
    examine("jkr_half_width", half_width=half_width / contact.radius)
    return half_width


def _smallest_width(contact: Contact, w: float) -> float:
    """Return the half-width at the smallest load, where the load of Eq. (15) has its minimum."""
    return (2 * contact.radius**2 * w / (np.pi * contact.effective_modulus)) ** (1 / 3)


def _checked_work(contact: Contact, work_of_adhesion: str | float) -> float:
    """Return the work of adhesion; an AnalysisError for a layer, where JKR theory is not valid."""
    work = _work(work_of_adhesion)
    if work and contact.thickness < np.inf:
        raise AnalysisError("work_of_adhesion: JKR's theory is of a half-space, not of a layer")
    return work


def _work(work_of_adhesion: str | float) -> float:
    w = to_si(work_of_adhesion, "J/m2", name="work_of_adhesion")
    if not 0 <= w < np.inf:
        raise AnalysisError(f"work_of_adhesion: it must be finite and not negative; got {w:g} J/m2")
    return w


def _loads(load: str | ArrayLike, contact: Contact) -> np.ndarray:
    number = to_si(load, contact.load_unit, name="load") if isinstance(load, str) else load
    force = np.asarray(number, dtype=float)
    if not np.all(np.isfinite(force)):
        raise AnalysisError(f"load: every load must be a finite number in {contact.load_unit}")
    return force
