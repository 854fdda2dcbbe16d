"""Text on the Hurst exponent of a surface, above all if it exceeds 1."""

from __future__ import annotations

import math

_STEEP = (
    "not a self-affine fractal over this range, for which H lies between 0 and 1. The spectrum "
    "falls faster than q to the −4, so the slope of the surface stays finite even if "
    "shorter waves are included: the surface is smooth (differentiable) at short distances. H then "
    "describes only the steepness of the spectrum, not how roughness grows with length"
)
_OPEN = (
    "not distinguishable from 1: within its error, the surface may be a self-affine fractal (H "
    "below 1) or a surface with a finite slope at short wavelengths (H above 1)"
)
_SIGMAS = 2.0  # standard errors by which an exponent must exceed 1


def is_steep(hurst: float | None, error: float | None = None) -> bool:
    """Return whether a Hurst exponent exceeds 1 significantly."""
    if hurst is None or not math.isfinite(hurst):
        return False
    return hurst - _SIGMAS * _known(error) > 1


def hurst_verdict(hurst: float | None, error: float | None = None) -> str:
    """Return a text on an exponent at or above 1; "" between 0 and 1.

    Parameters
    ----------
    hurst
        Exponent H [1] of the power law ``C ~ q^(-2(1+H))``.
    error
        Its standard error [1]; None if it was not estimated.

    Notes
    -----
    The mean square slope is ``2 pi int q^3 C dq``, whose integrand falls as ``q^(1-2H)``: it stays
    finite without a cut-off if H > 1, and mean square height differences then grow as the
    distance squared, whatever H is.

    Examples
    --------
    >>> hurst_verdict(0.8)
    ''
    >>> hurst_verdict(1.02, 0.02).partition(":")[0]
    'not distinguishable from 1'
    >>> hurst_verdict(1.19).partition(",")[0]
    'not a self-affine fractal over this range'
    """
    if hurst is None or not math.isfinite(hurst):
        return ""
    if is_steep(hurst, error):
        return _STEEP
    return _OPEN if hurst + _SIGMAS * _known(error) > 1 else ""


def _known(error: float | None) -> float:
    return error if error is not None and math.isfinite(error) else 0.0
