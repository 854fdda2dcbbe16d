"""Priors of the parameters of a joint fit."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from tribolab.core.errors import AnalysisError


@dataclass(frozen=True)
class JointPriors:
    """Priors of a joint fit: normal for the parameters, Rayleigh for sizes of shared errors.

    Parameters
    ----------
    shear_stress, shear_stress_spread
        Median of sigma_0 [Pa] and the standard deviation of its logarithm.
    speed_exponent, load_exponent
        Standard deviations of n and m about 0; 0 makes the shear stress independent of speed or
        load.
    viscosity_spread
        Standard deviation of ln eta about the stated viscosity.
    level
        Scale of tau, the relative error common to all points of a run or load.
    correlated
        Scale of kappa, the relative error correlated between neighbouring speeds.
    correlation_length
        Correlation length of that error, in ln v.
    dry_over_wet
        Standard deviation of ln(dry/wet shear stress), if dry curves are given.

    Raises
    ------
    AnalysisError
        If a number is not finite, or negative.

    Notes
    -----
    The prior interval of an exponent is two standard deviations on each side: n from -0.2 to 0.2 is
    a factor of 6 over four decades, m from -0.6 to 0.6 a factor of 3 over the loads of Xu et al.
    (2026), who find m between -0.3 and 0.

    A few loads hardly determine tau and kappa. With a prior that is highest at zero, such as a
    half-normal, 95 % intervals then have a coverage of some 93.5 %. The Rayleigh prior, x
    exp(-x^2/2) in units of the scale, is zero there [1]_, and the coverage is 95 %
    (`tests/coverage/joint_fit_coverage.py`).

    References
    ----------
    .. [1] Y. Chung, S. Rabe-Hesketh, V. Dorie, A. Gelman, J. Liu, Psychometrika 78, 685 (2013).
       doi:10.1007/s11336-013-9328-2

    Examples
    --------
    >>> constant = JointPriors(speed_exponent=0, load_exponent=0)  # one shear stress for all
    >>> constant.viscosity_spread
    0.3
    """

    shear_stress: float = 0.5e6
    shear_stress_spread: float = 1.0
    speed_exponent: float = 0.1
    load_exponent: float = 0.3
    viscosity_spread: float = 0.3
    level: float = 0.10
    correlated: float = 0.03
    correlation_length: float = 1.15
    dry_over_wet: float = 0.3

    def __post_init__(self) -> None:
        """Raise an error unless each value is finite and above 0, or 0 to fix its parameter."""
        free = ("speed_exponent", "load_exponent", "viscosity_spread")  # 0 fixes these parameters
        for name in (field.name for field in fields(self)):
            value = getattr(self, name)
            if not (np.isfinite(value) and (value > 0 or (value == 0 and name in free))):
                or_zero = " or zero" if name in free else ""
                raise AnalysisError(
                    f"priors: {name} must be finite and above zero{or_zero}; got {value:g}"
                )
