"""Error bars of friction: expanded uncertainty, or standard deviation as in the reference study."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr
from scipy import special

from tribolab.core.errors import AnalysisError, shown

ErrorBars = Literal["U95", "std"]
COVERAGE = float(special.ndtri(0.975))  # half a normal 95 % interval in standard errors


def error_bar(data: xr.Dataset, name: str, kind: ErrorBars = "U95") -> np.ndarray:
    """Return the half length of the error bar of each point.

    Parameters
    ----------
    data
        A measured curve or a friction result.
    name
        Name of the variable, e.g. ``"friction_coefficient"``.
    kind
        ``"U95"``: the expanded uncertainty (95 % coverage). ``"std"``: the standard deviation while
        sliding, the error bar of the reference study.

    Returns
    -------
    numpy.ndarray
        In the unit and with the dims of the variable; NaN if unknown. If the data have a standard
        error but no expanded uncertainty, U95 is 1.96 standard errors.

    Raises
    ------
    AnalysisError
        If the kind of error bar does not exist.

    Examples
    --------
    >>> curve = xr.Dataset({"friction_coefficient": ("sliding_speed", [0.3]),
    ...     "friction_coefficient_U95": ("sliding_speed", [0.02])})
    >>> error_bar(curve, "friction_coefficient"), error_bar(curve, "friction_coefficient", "std")
    (array([0.02]), array([nan]))
    """
    if kind not in ("U95", "std"):
        raise AnalysisError(f"errors = '{shown(kind)}' is not known; take 'U95' or 'std'")
    if f"{name}_{kind}" in data:
        return np.atleast_1d(np.asarray(data[f"{name}_{kind}"], float))
    if kind == "U95" and f"{name}_sem" in data:
        return COVERAGE * np.atleast_1d(np.asarray(data[f"{name}_sem"], float))
    return np.full(np.atleast_1d(data[name]).shape, np.nan)
