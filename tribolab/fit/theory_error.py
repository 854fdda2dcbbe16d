"""Flow factors and contact pressure, corrected by known differences from numerical results."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from tribolab.contact.separation import Separation
from tribolab.lubrication.factor_table import FactorTable
from tribolab.lubrication.factors import FlowFactors

EXCESS_OF_SHEAR = 0.24  # largest excess of phi_f over numerical results, from 2 to 3.2 h_rms
LACK_OF_PRESSURE = 0.17  # relative increase of p(u) below _CLOSE that gives numerical results
_NUMERICS, _GAUSSIAN = 3.2, 5.0  # u/h_rms: end of numerical results, start of Gaussian gaps
_CLOSE, _APART = 0.14, 0.28  # u/h_rms at which the correction of p(u) starts to decrease, and ends


def factors_of_numerics(factors: FlowFactors) -> FlowFactors:
    """Return factors with phi_f from numerical results, and the Gaussian limit at large separation.

    Parameters
    ----------
    factors
        From `flow_factors`.

    Notes
    -----
    Up to 3.2 h_rms phi_f is divided by 1.24, the largest ratio to direct numerics (which exist from
    2 h_rms on). From 5 h_rms on all factors are ``limit + c (h/u)^2``, the limit of Gaussian gaps:
    phi_fs of effective-medium theory exceeds this limit by up to 40 %. Between 3.2 and 5 h_rms the
    factors pass smoothly from one to the other.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.lubrication.factors import flow_factors
    >>> q, c = [1e3, 1e5, 1e9], [1e-22, 1e-22, 1e-38]
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
    >>> factors = flow_factors(psd)
    >>> u = np.array([2.0, 6.0]) * factors.rms_roughness
    >>> changed = factors_of_numerics(factors).at(u).phi_f / factors.at(u).phi_f
    >>> changed.round(2).tolist()
    [0.81, 0.98]
    """
    flow, friction = factors.flow, factors.friction
    if flow is None or friction is None:
        return factors
    height = factors.rms_roughness
    lower = friction.values / np.array([[1 + EXCESS_OF_SHEAR], [1.0]])
    return replace(
        factors,
        model=f"{factors.model}, phi_f and large separations as in numerics",
        flow=_gaussian_beyond(flow, flow.values, height),
        friction=_gaussian_beyond(friction, lower, height),
    )


def _gaussian_beyond(table: FactorTable, values: np.ndarray, height: float) -> FactorTable:
    """Return a table with given values at small separation and the Gaussian limit at large."""
    start, end = np.log(_NUMERICS), np.log(_GAUSSIAN)
    part = ((np.log(table.u / height) - start) / (end - start)).clip(0, 1)
    part = part**2 * (3 - 2 * part)
    far = table.limit[:, None] + table.coefficient[:, None] / table.u**2
    mixed = np.where(part > 0, (1 - part) * values + part * far, values)
    return replace(table, values=mixed)


def pressure_of_numerics(table: Separation) -> Separation:
    """Return p(u) raised at small separations by 17 %, its largest deviation from numerics.

    Parameters
    ----------
    table
        From `separation_table`.

    Notes
    -----
    Between 0.14 and 0.28 h_rms the ratio falls to 1; p(u) stays monotone.

    Examples
    --------
    >>> import xarray as xr
    >>> from tribolab.contact.separation import separation_table
    >>> q, c = [1e3, 1e5, 1e9], [1e-22, 1e-22, 1e-38]
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
    >>> table = separation_table(psd, "2 MPa")
    >>> u = 0.1 * table.rms_roughness
    >>> f"{pressure_of_numerics(table).pressure(u) / table.pressure(u):.3f}"
    '1.170'
    """
    height = table.rms_roughness
    changing = np.linspace(_CLOSE, _APART, 20)
    knots = np.union1d(table._curve.x, np.log(np.expm1(changing)))
    separation = height * np.logaddexp(0.0, knots)
    part = ((_APART - separation / height) / (_APART - _CLOSE)).clip(0, 1)
    raised = np.log1p(LACK_OF_PRESSURE) * part**2 * (3 - 2 * part)
    # derivative d(u/h)/dU = 1 - exp(-u/h)
    steeper = np.log1p(LACK_OF_PRESSURE) * 6 * part * (1 - part) / (_CLOSE - _APART)
    steeper *= -np.expm1(-separation / height)
    log_p = table._curve(knots) + raised
    return replace(
        table,
        table_pressure=np.exp(log_p[::-1]),
        table_separation=separation[::-1],
        _curve=CubicHermiteSpline(knots, log_p, table._curve(knots, 1) + steeper),
    )
