"""Validity limits of the theories, and warnings if a result exceeds them.

Every model result has the attributes ``validity`` ("pass" or "suspect") and ``validity_reasons``
from `examine`; campaigns report them as findings. Beyond the second, wider limit an error is
raised.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribolab.core.errors import AnalysisError

_PASS, _SUSPECT = "pass", "suspect"
TINY = float(np.finfo(float).tiny)  # lower limit of denominators that can be 0


@dataclass(frozen=True)
class ValidityLimit:
    """Limits within which an approximation of the theory is valid.

    Parameters
    ----------
    what
        The number compared, in words.
    suspect
        Above this a result is doubtful.
    refuse
        Above this there is no result.
    because
        The assumption of the theory that fails.
    cure
        Remedy.
    """

    what: str
    suspect: float
    refuse: float
    because: str
    cure: str


LIMITS = {
    "film": ValidityLimit(
        "film thickness over the radius R",
        # where the film has doubled, at x = sqrt(2 R h), a cylinder is higher than the parabola:
        1e-2,  # by 0.5 % here, and by 6 % at h = R/10
        0.5,  # by a factor of 2, at the edge of the cylinder, x = R
        "the gap is taken as a parabola and the film as thin",
        "take lower speeds or a thinner liquid",
    ),
    "half_width": ValidityLimit(
        "half-width of the contact over the radius R",
        0.3,
        1.0,
        "the bodies are taken as a parabola on a half-space",
        "take a smaller load, a larger radius or a stiffer body, or compute with finite elements",
    ),
    "thickening": ValidityLimit(
        "rise of an oil's viscosity at the highest pressure, in its logarithm",
        0.1,  # the drag in the middle of the contact rises by 10 %, the film thickness by less
        np.inf,  # warns only: the liquid may be water, which does not thicken under pressure
        "the viscosity is taken to be the same at every pressure, as between soft bodies",
        "take a smaller load or a softer body, or a theory of elastohydrodynamics between hard "
        "ones",
    ),
    "slope": ValidityLimit(
        "rms slope of the surface",
        1.0,
        5.0,
        "slopes are taken as small in elasticity and flow",
        "end the spectrum at a smaller wavenumber (q_high), or look whether the scans hold noise",
    ),
    "binding": ValidityLimit(
        "gamma_eff at magnification 1 over the work of adhesion",
        1.0,
        3.0,
        "roughness cannot bind more than smooth surfaces do but by its larger area",
        "look at work of adhesion, modulus and spectrum: so soft a body is in complete contact, "
        "and capillary or large-strain theories apply",
    ),
    "frequency": ValidityLimit(
        "share of rubber friction or stiffness from frequencies outside the modulus table",
        0.05,
        0.98,
        "outside its table the modulus is a guess",
        "give a master curve that reaches over the frequencies q v (shift sweeps of several "
        "temperatures), or other speeds",
    ),
    "heating": ValidityLimit(
        "temperature rise in K in the contact spots of sliding rubber",
        10.0,  # the relaxation of rubber becomes about two times as fast
        np.inf,  # warns only: the decrease of friction is not computed
        "the modulus is that of the rubber at rest, without heat by friction",
        "take lower speeds, or the modulus at the temperature of the contact",
    ),
    "pressure": ValidityLimit(
        "contact pressure over the largest in the table of p(u)",
        1.0,
        # at the end of the table u is 1e-17 h_rms; beyond, it falls as exp(-k p^2). At 4 times the
        # last pressure p(u) still inverts to 1e-5, at 5 times dp/du overflows, at 5.3 times u is 0
        4.0,
        "beyond it the roughness is pressed flat and p(u) is extrapolated",
        "take a smaller load, or smooth surfaces",
    ),
}


def examine(who: str, where: str = "", **values: Any) -> dict[str, str]:
    """Compare numbers with the validity limits, and return the validity attributes of a result.

    Parameters
    ----------
    who
        The calling function, for the error message.
    where
        Load, speed or surface, for the message.
    **values
        The numbers [1] by the limits' names; for arrays the largest, ignoring NaN.

    Returns
    -------
    dict
        Attributes ``validity`` ("pass" or "suspect") and ``validity_reasons``, "" for "pass".

    Raises
    ------
    AnalysisError
        If a number is beyond the second limit.

    Examples
    --------
    >>> examine("curve", half_width=0.1)["validity"]
    'pass'
    >>> examine("curve", "at 9 N/m", half_width=[0.1, 0.5])["validity_reasons"][:66]
    'half-width of the contact over the radius R is 0.5 at 9 N/m, above'
    """
    reasons = []
    for name, value in values.items():
        limit, numbers = LIMITS[name], np.asarray(value, dtype=float)
        numbers = numbers[~np.isnan(numbers)]
        if not numbers.size or not (largest := float(numbers.max())) > limit.suspect:
            continue
        compared = f"{limit.what} is {largest:.3g}{f' {where}' if where else ''}"
        if largest > limit.refuse:
            raise AnalysisError(
                f"{compared}, far above {limit.suspect:g}: {limit.because}",
                function=who,
                cure=limit.cure,
            )
        reasons.append(f"{compared}, above {limit.suspect:g}: {limit.because}; {limit.cure}")
    return {
        "validity": _SUSPECT if reasons else _PASS,
        "validity_reasons": " | ".join(reasons),
    }


def together(attrs: Iterable[Mapping[Any, Any]]) -> dict[str, str]:
    """Return the combined validity attributes of several results, without repeated reasons.

    Examples
    --------
    >>> one = {"validity": "suspect", "validity_reasons": "too steep"}
    >>> together([one, one, {"validity": "pass", "validity_reasons": ""}, {}])
    {'validity': 'suspect', 'validity_reasons': 'too steep'}
    """
    reasons = [reason for result in attrs for reason in reasons_of(result)]
    unique = list(dict.fromkeys(reasons))
    return {"validity": _SUSPECT if unique else _PASS, "validity_reasons": " | ".join(unique)}


def reasons_of(attrs: Mapping[Any, Any]) -> list[str]:
    """Return why a result is outside the validity of the theory, from its attributes."""
    return [reason for reason in str(attrs.get("validity_reasons", "")).split(" | ") if reason]
