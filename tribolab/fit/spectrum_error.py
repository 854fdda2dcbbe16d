"""Error of a fitted shear stress due to an uncertain spectrum, which repeats cannot reduce."""

from __future__ import annotations

import numpy as np
import xarray as xr

SPECTRUM = (
    "spectrum band",
    "spectrum at long waves",
    "Hurst exponent",
    "spectrum at short waves",
)


def shear_stress_shift(uncertainty: xr.Dataset) -> tuple[float, float]:
    """Return the possible error of a fitted sigma_f due to an uncertain spectrum, down and up.

    Parameters
    ----------
    uncertainty
        From `model_uncertainty`.

    Returns
    -------
    tuple
        Relative changes [1] of sigma_f, zero or negative and zero or positive; the variations are
        combined in quadrature, as in the band of the curve.
    """
    mine = uncertainty.sel(variation=[n for n in uncertainty.variation.values if n in SPECTRUM])
    ends = np.nan_to_num(
        np.stack([mine[f"shear_stress_change_{end}"].values for end in ("low", "high")])
    )
    down, up = np.minimum(ends.min(axis=0), 0), np.maximum(ends.max(axis=0), 0)
    return -float(np.linalg.norm(down)), float(np.linalg.norm(up))
