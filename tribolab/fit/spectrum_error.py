"""What an uncertain spectrum does to a fitted shear stress: repeats do not help."""

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
    """Return how far a fitted sigma_f may lie off, down and up, as the spectrum is not known.

    Parameters
    ----------
    uncertainty
        From `model_uncertainty`.

    Returns
    -------
    tuple
        Relative changes [1] of sigma_f, not above and not below 0: those that lower it and those
        that raise it, each in quadrature, as the band of the curve.
    """
    mine = uncertainty.sel(variation=[n for n in uncertainty.variation.values if n in SPECTRUM])
    ends = np.nan_to_num(
        np.stack([mine[f"shear_stress_change_{end}"].values for end in ("low", "high")])
    )
    down, up = np.minimum(ends.min(axis=0), 0), np.maximum(ends.max(axis=0), 0)
    return -float(np.linalg.norm(down)), float(np.linalg.norm(up))
