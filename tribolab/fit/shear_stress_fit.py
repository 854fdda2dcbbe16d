"""What a fit of the shear stress found, and how well it is known."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pandas as pd
import xarray as xr
from scipy import special

from tribolab.core.errors import AnalysisError, Cure
from tribolab.fit import limits

_UNITS = {"viscosity": "Pa s", "youngs_modulus": "Pa"}  # of what may be fitted besides


@dataclass(frozen=True, eq=False)
class ShearStressFit:
    """A fitted shear stress, how well it fits, and the curve that goes with it.

    Parameters
    ----------
    shear_stress
        sigma_f [Pa], effective: for the contact area without adhesion.
    shear_stress_error
        Its standard error [Pa] from those of the measured points.
    shear_stress_error_inflated
        The same with what the residuals tell of the points' errors: whether they are too small by
        one factor, and whether those of neighbouring speeds go together (see `residual_error`).
    scatter_half_interval
        Half the 95 % interval [Pa] that belongs to it.
    residual_correlation
        Correlation [1] of the errors of neighbouring speeds, as the residuals tell it.
    chi_square, degrees_of_freedom, chi_square_p_value
        Of the residuals.
    birge_ratio
        sqrt(chi_square/degrees_of_freedom).
    runs_p_value
        Probability of so few changes of the residuals' sign by chance; small means that the
        measured curve has another shape.
    valid_speed_range
        Ends [m/s] of the widest range of speeds that one sigma_f describes (chi-square's
        probability above 0.01 when fitted alone); NaN if none of four speeds or more does.
    common_error
        The part [Pa] of the standard error that all points have in common, such as the level of
        the runs; not in `shear_stress_error`.
    common_freedom
        Degrees of freedom from which that part is known.
    area_enhancement, area_enhancement_error
        Real contact area with adhesion over that without [1], as given.
    curve
        The computed curve at the measured speeds, with ``friction_coefficient_residual`` [1]
        (measured less computed; NaN where nothing was measured) and ``used``.
    error_from
        Where the points' errors come from: "sem", "std" or "scatter".
    spectrum_error
        Relative changes [1] of sigma_f, down (not above 0) and up, that an uncertain spectrum
        may make, from `shear_stress_shift`; None if it is not known.
    spectrum_scanned
        Whether the spectrum was measured, so that its error counts.
    parameters, covariance
        Names and values of all free parameters in SI, sigma_f first, and their covariance.
    """

    shear_stress: float
    shear_stress_error: float
    shear_stress_error_inflated: float
    scatter_half_interval: float
    residual_correlation: float
    chi_square: float
    degrees_of_freedom: int
    chi_square_p_value: float
    birge_ratio: float
    runs_p_value: float
    valid_speed_range: tuple[float, float]
    common_error: float
    common_freedom: float
    area_enhancement: float
    area_enhancement_error: float
    error_from: str
    spectrum_error: tuple[float, float] | None
    spectrum_scanned: bool
    curve: xr.Dataset = field(repr=False)
    parameters: dict[str, float] = field(repr=False)
    covariance: np.ndarray = field(repr=False)

    @property
    def total_error(self) -> float:
        """Standard error [Pa] but for the spectrum's: the points' scatter and what they share."""
        return float(np.hypot(self.shear_stress_error_inflated, self.common_error))

    @property
    def statistical_half_interval(self) -> float:
        """Half the 95 % interval of sigma_f [Pa] for the spectrum as it is given.

        Two parts in quadrature: that of the points, and the common error with the Student's t of
        its own degrees of freedom; known from two runs alone, which may agree by chance, it counts
        with the t of one degree of freedom.
        """
        t = special.stdtrit(max(self.common_freedom, 1.0), 0.975)
        return float(np.hypot(self.scatter_half_interval, t * self.common_error))

    @property
    def interval(self) -> tuple[float, float]:
        """Ends of the 95 % interval of sigma_f [Pa], with the spectrum's error if it was measured.

        Raises
        ------
        AnalysisError
            If the spectrum was measured and its error is not known.
        """
        if self.spectrum_scanned and self.spectrum_error is None:
            raise AnalysisError(
                "the spectrum was measured, and its error is not in this fit",
                where="interval",
                cure=Cure(
                    notebook="give fit_shear_stress the argument spectrum_error=shear_stress_shift("
                    "model_uncertainty(...)), or take statistical_half_interval and say so"
                ),
            )
        parts = np.abs(self.spectrum_error or (0.0, 0.0)) * abs(self.shear_stress)
        low, high = np.hypot(self.statistical_half_interval, parts)
        return float(self.shear_stress - low), float(self.shear_stress + high)

    @property
    def half_interval(self) -> float:
        """Half the 95 % interval of sigma_f [Pa], to its farther end; see `interval`."""
        return float(np.max(np.abs(np.array(self.interval) - self.shear_stress)))

    @property
    def interval_says(self) -> str:
        """What the 95 % interval holds, and which quantile was taken, in words."""
        return interval_words(
            self.common_error > 0,
            self.common_freedom,
            self.error_from,
            self.degrees_of_freedom,
            self.residual_correlation,
        )

    @property
    def corrected_shear_stress(self) -> float:
        """Shear stress [Pa] in the area that adhesion makes: sigma_f / area_enhancement."""
        return self.shear_stress / self.area_enhancement

    @property
    def corrected_shear_stress_error(self) -> float:
        """Standard error [Pa] of `corrected_shear_stress`, from `total_error` and the area's."""
        return abs(self.corrected_shear_stress) * np.hypot(
            self.total_error / self.shear_stress,
            self.area_enhancement_error / self.area_enhancement,
        )

    def to_dataframe(self) -> pd.DataFrame:
        """Return what was found as a table: ``value``, ``unit`` and ``meaning`` by name.

        ``interval_low`` and ``interval_high`` are the ends of the 95 % interval. Where the error
        of the spectrum is not known there is no such interval, and half the statistical one stands
        there instead.
        """
        half = self.statistical_half_interval
        if self.spectrum_scanned and self.spectrum_error is None:
            ends = [("statistical_half_interval", half, "Pa", "half of it, spectrum as given")]
        else:
            low, high = self.interval
            ends = [
                ("interval_low", low, "Pa", "lower end of the 95 % interval"),
                ("interval_high", high, "Pa", "upper end of the 95 % interval"),
            ]
        slowest, fastest = self.valid_speed_range
        rows = [
            ("shear_stress", self.shear_stress, "Pa", "shear stress in the real contact"),
            ("total_error", self.total_error, "Pa", "its standard error without the spectrum's"),
            *ends,
            ("common_error", self.common_error, "Pa", "what all points share of the error"),
            ("chi_square", self.chi_square, "1", "sum of squares of residual / error"),
            ("degrees_of_freedom", self.degrees_of_freedom, "1", "points less parameters"),
            ("chi_square_p_value", self.chi_square_p_value, "1", "chance of so large a sum"),
            ("runs_p_value", self.runs_p_value, "1", "chance of so few changes of sign"),
            ("residual_correlation", self.residual_correlation, "1", "of neighbouring speeds"),
            ("slowest_valid_speed", slowest, "m/s", "from where on one stress describes all"),
            ("fastest_valid_speed", fastest, "m/s", "up to where one stress describes all"),
            ("area_enhancement", self.area_enhancement, "1", "area with adhesion over without"),
            ("corrected_shear_stress", self.corrected_shear_stress, "Pa", "in the adhesive area"),
            ("corrected_shear_stress_error", self.corrected_shear_stress_error, "Pa",
             "its standard error"),
        ]  # fmt: skip
        rows += [
            (name, value, _UNITS[name], "fitted as well")
            for name, value in self.parameters.items()
            if name != "shear_stress"
        ]
        columns = ["name", "value", "unit", "meaning"]
        return pd.DataFrame(rows, columns=columns).set_index("name")

    def _repr_html_(self) -> str:
        """Shear stress, error and fit in a sentence each; everything else folded away."""
        stress, error = 1e-6 * self.shear_stress, 1e-6 * self.total_error
        without = "" if self.common_error else ", statistical only"
        if self.spectrum_scanned and self.spectrum_error is None:
            ends = "no 95 % interval: the error of the measured spectrum is not in this fit"
        else:
            low, high = (1e-6 * end for end in self.interval)
            ends = f"95 % interval {low:.3g} to {high:.3g} MPa; {self.interval_says}"
        table = self.to_dataframe().to_html(float_format=lambda number: f"{number:.4g}")
        return (
            f"<p><b>shear stress {stress:.3g} MPa</b> (standard error {error:.2g} MPa{without})<br>"
            f"{ends}<br>chi-square {self.chi_square:.3g} of {self.degrees_of_freedom} degrees of "
            f"freedom (probability {self.chi_square_p_value:.2g})</p>"
            f"<details><summary>all numbers in SI</summary>{table}</details>"
        )


def interval_words(
    shared: bool, common_freedom: float, error_from: str, freedom: int, correlation: float
) -> str:
    """Say which quantiles a 95 % interval of sigma_f was made with, and of what.

    Examples
    --------
    >>> interval_words(True, 3, "sem", 11, 0.62)
    "residuals of neighbouring speeds correlate by 0.62; repeatability with Student's t of 3 degrees of freedom"
    """  # noqa: E501 (the sentence is one line)
    parts = [f"residuals of neighbouring speeds correlate by {correlation:.2g}"]
    if error_from == "scatter":
        parts.append(f"scatter with Student's t of {freedom} degrees of freedom")
    if shared and common_freedom < limits.MAX_FREEDOM_TO_REPORT.value:
        parts.append(
            f"repeatability with Student's t of {max(common_freedom, 1):.3g} degrees of freedom"
        )
    elif not shared:
        parts.append("the repeatability of a run's level is not known and not in it")
    return "; ".join(parts)
