"""Flow and friction factors of Patir and Cheng, for comparison with other factors."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from tribolab.lubrication.factor_table import FactorTable
from tribolab.lubrication.factors import FlowFactors, RoughBody, check_rough_body
from tribolab.units.conversion import positive

_CONTACT = 1 / 300  # gap over h_rms below which no fluid is sheared


def patir_cheng(rms_roughness: str | float, rough_body: RoughBody = "stationary") -> FlowFactors:
    """Return the flow and friction factors of Patir and Cheng, for isotropic Gaussian roughness.

    Notes
    -----
    With H the distance of the undeformed mean planes over h_rms, the reference film is nominal, h =
    H h_rms: the pressure flow is phi_p h^3, the stresses are (phi_f + phi_fs) eta v/h and phi_fp
    h/2 dp/dx, with phi_p = 1 - 0.90 exp(-0.56 H); phi_s = 1.899 H^0.98 exp(-0.92 H + 0.05 H^2) up
    to H = 5, 1.126 exp(-0.25 H) beyond [1]_; phi_fp = 1 - 1.40 exp(-0.66 H), phi_fs = 11.1 H^2.31
    exp(-2.38 H + 0.11 H^2) up to H = 7 and falling as 1/H^2 beyond, phi_f = h <1/gap> over gaps
    above h_rms/300 [2]_. `FlowFactors` refers all of them to the mean separation u of the remaining
    gap: u/h_rms = H Phi(H) + exp(-H^2/2)/sqrt(2 pi), exact for Gaussian heights truncated at
    contact. They are converted accordingly: phi_p by (h/u)^3, phi_fp by h/u, phi_f and phi_fs by
    u/h. phi_s, a factor of h_rms, is unchanged, because their Couette flow has the mean gap. The
    fits are valid above H = 0.5; below, phi_p is extrapolated to H = 0, where phi_p h^3 is 0, and
    phi_fp is at least 1e-3. phi_s and phi_fp were fitted separately and are not reciprocal, unlike
    effective-medium factors.

    References
    ----------
    .. [1] N. Patir, H. S. Cheng, J. Lubr. Technol. 100, 12 (1978). doi:10.1115/1.3453103
    .. [2] N. Patir, H. S. Cheng, "Application of Average Flow Model to Lubrication Between Rough
       Sliding Surfaces", J. Lubr. Technol. 101, 220 (1979).
    """
    check_rough_body(rough_body)
    height = positive(rms_roughness, "m", "rms_roughness")
    nominal = np.geomspace(1e-4, 60.0, 240)
    low, high = np.minimum(nominal, 5.0), np.minimum(nominal, 7.0)
    shear = np.where(
        nominal <= 5,
        1.899 * nominal**0.98 * np.exp(-0.92 * nominal + 0.05 * low**2),
        1.126 * np.exp(-0.25 * nominal),
    )
    shear[:2] = 0.0  # there is no flow at the two lowest separations: keep the factors constant
    correction = 11.1 * high**2.31 * np.exp(-2.38 * high + 0.11 * high**2)
    correction = correction * (high / nominal) ** 2
    mean = _mean_gap(nominal)
    part = nominal / mean  # nominal over mean gap, h/u
    conductance = (1 - 0.90 * np.exp(-0.56 * nominal)) * part**3
    drag = np.maximum((1 - 1.40 * np.exp(-0.66 * nominal)) * part, 1e-3)
    closing = float(_mean_gap(np.array(0.0)))
    zero = np.zeros(2)
    return FlowFactors(
        rms_roughness=height,
        percolation_separation=height * closing,
        rough_body=rough_body,
        model="Patir and Cheng (1978, 1979), isotropic",
        flow=FactorTable(
            height * mean,
            np.stack([conductance, 1 - shear / mean]),
            height * closing,
            zero,
            np.ones(2),
        ),
        friction=FactorTable(
            height * mean,
            np.stack([mean * _mean_inverse(nominal), np.maximum(correction / part, 1e-12), drag]),
            0.0,
            np.array([height**2, 0.0, 0.0]),
            np.array([1.0, 0.0, 1.0]),
        ),
    )


def _mean_gap(distance: np.ndarray) -> np.ndarray:
    return distance * ndtr(distance) + np.exp(-(distance**2) / 2) / np.sqrt(2 * np.pi)


def _mean_inverse(distance: np.ndarray) -> np.ndarray:
    """Return the mean of 1/gap for Gaussian heights, by the trapezoidal rule in ln(gap)."""
    log_gap = np.linspace(np.log(_CONTACT), np.log(80.0), 4001)
    bell = np.exp(-((np.exp(log_gap) - distance[:, None]) ** 2) / 2) / np.sqrt(2 * np.pi)
    return np.trapezoid(bell, log_gap, axis=1)
