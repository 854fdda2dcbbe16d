"""The factors of Patir and Cheng, for comparison."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from tribolab.lubrication.factors import FactorTable, FlowFactors, RoughBody, check_rough_body
from tribolab.units import positive

_CLOSED = np.log(0.90) / 0.56  # H at which phi_p is 0
_CONTACT = 1 / 300  # gap in h_rms under which there is no fluid to shear


def patir_cheng(rms_roughness: str | float, rough_body: RoughBody = "stationary") -> FlowFactors:
    """Flow and friction factors of Patir and Cheng for isotropic Gaussian roughness.

    Parameters
    ----------
    rms_roughness
        h_rms [m].
    rough_body
        ``"stationary"`` or ``"moving"``, as for `flow_factors`.

    Returns
    -------
    FlowFactors
        To be given to `stribeck_curve` as ``factors``.

    Notes
    -----
    With H the distance of the undeformed mean planes over h_rms, phi_p = 1 - 0.90 exp(-0.56 H);
    phi_s = 1.899 H^0.98 exp(-0.92 H + 0.05 H^2) up to H = 5, 1.126 exp(-0.25 H) beyond [1]_;
    phi_fp = 1 - 1.40 exp(-0.66 H), phi_fs = 11.1 H^2.31 exp(-2.38 H + 0.11 H^2) up to H = 7 and
    falling as 1/H^2 beyond, phi_f = u <1/gap> over gaps above h_rms/300 [2]_. The mean separation
    is that of what gap is left, ``u/h_rms = H Phi(H) + exp(-H^2/2)/sqrt(2 pi)``. The fits hold
    above H = 0.5; phi_p is followed down to where it is 0 and phi_fp kept at 1e-3 or more. phi_s
    and phi_fp are fitted apart and not reciprocal, as effective-medium factors are.

    References
    ----------
    .. [1] N. Patir, H. S. Cheng, J. Lubr. Technol. 100, 12 (1978). doi:10.1115/1.3453103
    .. [2] N. Patir, H. S. Cheng, "Application of Average Flow Model to Lubrication Between Rough
       Sliding Surfaces", J. Lubr. Technol. 101, 220 (1979).

    Examples
    --------
    >>> factors = patir_cheng("1 um").at(3e-6)
    >>> f"{float(factors.phi_p):.3f} {float(factors.phi_s):.3f}"
    '0.832 -0.553'
    """
    check_rough_body(rough_body)
    height = positive(rms_roughness, "m", "rms_roughness")
    above = _CLOSED + np.geomspace(1e-4, 60.0, 240)
    fitted = np.maximum(above, 0.0)
    low, high = np.minimum(fitted, 5.0), np.minimum(fitted, 7.0)
    shear = np.where(
        fitted <= 5,
        1.899 * fitted**0.98 * np.exp(-0.92 * fitted + 0.05 * low**2),
        1.126 * np.exp(-0.25 * fitted),
    )
    correction = 11.1 * high**2.31 * np.exp(-2.38 * high + 0.11 * high**2)
    correction = np.maximum(correction * (high / np.maximum(fitted, 1e-9)) ** 2, 1e-12)
    mean = _mean_gap(above)
    values = np.stack([1 - 0.90 * np.exp(-0.56 * above), 1 - shear / mean])
    drag = np.maximum(1 - 1.40 * np.exp(-0.66 * above), 1e-3)
    closing = float(_mean_gap(np.array(_CLOSED)))
    zero = np.zeros(2)
    return FlowFactors(
        rms_roughness=height,
        percolation_separation=height * closing,
        rough_body=rough_body,
        model="Patir and Cheng (1978, 1979), isotropic",
        flow=FactorTable(height * mean, values, height * closing, zero, np.ones(2)),
        friction=FactorTable(
            height * mean,
            np.stack([mean * _mean_inverse(above), correction, drag]),
            0.0,
            np.array([height**2, 0.0, 0.0]),
            np.array([1.0, 0.0, 1.0]),
        ),
    )


def _mean_gap(distance: np.ndarray) -> np.ndarray:
    return distance * ndtr(distance) + np.exp(-(distance**2) / 2) / np.sqrt(2 * np.pi)


def _mean_inverse(distance: np.ndarray) -> np.ndarray:
    """<1/gap> over Gaussian heights, by the trapezoidal rule in the gap's logarithm."""
    log_gap = np.linspace(np.log(_CONTACT), np.log(80.0), 4001)
    bell = np.exp(-((np.exp(log_gap) - distance[:, None]) ** 2) / 2) / np.sqrt(2 * np.pi)
    return np.trapezoid(bell, log_gap, axis=1)
