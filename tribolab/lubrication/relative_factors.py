"""Flow and friction factors over mean separation in units of h_rms."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.arrays.broadcasting import over_dims
from tribolab.lubrication.factors import flow_factors
from tribolab.units.stamping import stamp

_OVER = "relative_separation"


@over_dims(psd=("wavenumber",))
def relative_flow_factors(psd: xr.Dataset, over: ArrayLike, **options: Any) -> xr.Dataset:
    """Return flow and friction factors over the mean separation in units of the rms roughness.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber); a spectrum with a further dim, such as
        ``surface``, gives factors with that dim.
    over
        Mean separation over rms roughness [1].
    **options
        Further arguments of `flow_factors`.

    Returns
    -------
    xarray.Dataset
        The five factors of `flow_factors` [1] and ``separation`` [m], over
        ``relative_separation`` [1].

    Raises
    ------
    AnalysisError
        As `flow_factors`, and if a separation is not above zero.

    Examples
    --------
    >>> from tribolab.studies import xu2026
    >>> found = relative_flow_factors(xu2026.psd(["Smooth", "Sb-S"], points=301), [0.5, 2.0])
    >>> found.pressure_flow_factor.dims
    ('surface', 'relative_separation')
    >>> found.pressure_flow_factor.values.round(2).tolist()
    [[0.07, 0.68], [0.07, 0.68]]
    """
    table = flow_factors(psd, **options)
    relative = np.atleast_1d(np.asarray(over, float))
    separation = xr.DataArray(relative * table.rms_roughness, dims=_OVER, coords={_OVER: relative})
    factors = table.dataset(separation).reset_coords("separation")
    return stamp(factors, **{k: v for k, v in factors.attrs.items() if not k.endswith("_m")})
