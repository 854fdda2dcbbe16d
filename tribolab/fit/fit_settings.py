"""Settings of a fit of the shear stress."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.units.conversion import positive

_FREE = ("viscosity", "youngs_modulus")


@dataclass(frozen=True)
class FitSettings:
    """Settings of a fit: points, free parameters, and errors common to several points.

    Parameters
    ----------
    speed_range
        Lowest and highest speed [m/s] to fit; None for all.
    free
        Additional free parameters: ``"viscosity"``, ``"youngs_modulus"``; the given values are
        starting values.
    curve
        The computed curve, if available: `stribeck_curve` of the same system at the measured speeds
        (and others), with ``"0 Pa"``.
    area_enhancement, area_enhancement_error
        Ratio [1] of the real contact area with adhesion to that without, and its standard error.
    common_error, common_freedom
        Relative standard error [1] that all measured points share, such as the repeatability of a
        run's level over the square root of the number of runs, and its degrees of freedom.
    spectrum_error
        Relative changes [1] of sigma_f, down and up, due to an uncertain spectrum, from
        `shear_stress_shift`. Without it, a fit with a measured spectrum (one with ``psd_2d_low``)
        has only a statistical interval.
    abscissa_error
        Relative standard uncertainty [1] of viscosity times speed, constant along the curve; not
        used with a free viscosity, which includes it.
    inputs
        Changes of the curve due to uncertain load, radius and modulus, from `model_inputs`; a
        fitted modulus is left out.

    Examples
    --------
    >>> FitSettings(speed_range=("1 um/s", "1 mm/s"), common_error=0.02).area_enhancement
    1.0
    """

    speed_range: tuple[str | float, str | float] | None = None
    free: Sequence[str] = ()
    curve: xr.Dataset | None = None
    area_enhancement: float = 1.0
    area_enhancement_error: float = 0.0
    common_error: float = 0.0
    common_freedom: float = np.inf
    spectrum_error: tuple[float, float] | None = None
    abscissa_error: float = 0.0
    inputs: xr.Dataset | None = None

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error if a setting is impossible."""
        unknown = [name for name in self.free if name not in _FREE]
        if unknown:
            raise AnalysisError(
                f"free: '{shown(unknown[0])}' cannot be fitted{nearest(unknown[0], _FREE)}"
            )
        positive(self.area_enhancement, "1", "area_enhancement")
        if not 0 <= self.area_enhancement_error < np.inf:
            raise AnalysisError(
                "a standard error, finite and not negative, is wanted; got "
                f"{self.area_enhancement_error:g}",
                function="area_enhancement_error",
            )


SETTINGS = {field.name for field in fields(FitSettings)}


def merge_old_settings(
    settings: FitSettings | None, options: Mapping[str, Any]
) -> tuple[FitSettings, dict[str, Any]]:
    """Return settings updated by arguments that are now settings, and the other arguments."""
    old = {name: value for name, value in options.items() if name in SETTINGS}
    if old:
        warnings.warn(
            f"fits of the shear stress: {', '.join(old)} will no longer be arguments after the "
            "next release; give them to FitSettings",
            FutureWarning,
            stacklevel=4,
        )
    left = {name: value for name, value in options.items() if name not in SETTINGS}
    return replace(settings or FitSettings(), **old), left
