"""Result of a fit of the shear stress, with its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pandas as pd
import xarray as xr
from scipy import special

from tribolab.core.errors import AnalysisError, Cure
from tribolab.fit import limits

_UNITS = {"viscosity": "Pa s", "youngs_modulus": "Pa"}  # units of additional free parameters


@dataclass(frozen=True, eq=False)
class ShearStressFit:
    """Fitted shear stress, its goodness of fit, and the fitted curve.

    Parameters
    ----------
    shear_stress
        Effective sigma_f [Pa], for the contact area without adhesion.
    shear_stress_error
        Standard error [Pa] from the errors of the measured points.
    shear_stress_error_inflated
        The same, enlarged if the residuals exceed the points' errors or are correlated between
        neighbouring speeds (see `residual_error`).
    scatter_half_interval
        Half the 95 % interval [Pa] that belongs to `shear_stress_error_inflated`.
    residual_correlation
        Correlation [1] of the errors of neighbouring speeds, estimated from the residuals.
    chi_square, degrees_of_freedom, chi_square_p_value
        Chi-square test of the residuals.
    birge_ratio
        sqrt(chi_square/degrees_of_freedom).
    runs_p_value
        Probability of so few changes of the residuals' sign by chance; a small value means that the
        measured curve has another shape.
    valid_speed_range
        Ends [m/s] of the widest range of speeds that one sigma_f describes (chi-square's
        probability above 0.01 when fitted alone); NaN without such a range of at least four speeds.
    common_error
        Standard error [Pa] common to all points, e.g. from the level of the runs; not included in
        `shear_stress_error`.
    common_freedom
        Degrees of freedom of `common_error`.
    area_enhancement, area_enhancement_error
        Given ratio [1] of the real contact area with adhesion to that without, and its standard
        error.
    curve
        The computed curve at the measured speeds, with ``friction_coefficient_residual`` [1]
        (measured minus computed; NaN without a measurement) and ``used``.
    error_from
        Source of the points' errors: "sem", "std" or "scatter".
    spectrum_error
        Relative changes [1] of sigma_f, down (not above 0) and up, due to an uncertain spectrum,
        from `shear_stress_shift`; None if unknown.
    spectrum_scanned
        Whether the spectrum was measured, so that its error is included.
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
        """Standard error [Pa] due to scatter and shared errors, but not to the spectrum."""
        return float(np.hypot(self.shear_stress_error_inflated, self.common_error))

    @property
    def statistical_half_interval(self) -> float:
        """Half the 95 % interval of sigma_f [Pa] if the spectrum were exact.

        The interval due to the points, combined in quadrature with the common error times
        Student's t of its own degrees of freedom (one for two runs, which may agree by chance).
        """
        t = special.stdtrit(max(self.common_freedom, 1.0), 0.975)
        return float(np.hypot(self.scatter_half_interval, t * self.common_error))

    @property
    def interval(self) -> tuple[float, float]:
        """Ends of the 95 % interval of sigma_f [Pa], with the uncertainty of a measured spectrum.

        Raises
        ------
        AnalysisError
            If the spectrum was measured but its error is unknown.
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
        """Distance [Pa] from sigma_f to the farther end of the 95 % interval; see `interval`."""
        return float(np.max(np.abs(np.array(self.interval) - self.shear_stress)))

    @property
    def interval_says(self) -> str:
        """Text on the contributions to the 95 % interval, and its quantile."""
        return interval_words(
            self.common_error > 0,
            self.common_freedom,
            self.error_from,
            self.degrees_of_freedom,
            self.residual_correlation,
        )

    @property
    def corrected_shear_stress(self) -> float:
        """Shear stress [Pa] in the contact area with adhesion, sigma_f / area_enhancement."""
        return self.shear_stress / self.area_enhancement

    @property
    def corrected_shear_stress_error(self) -> float:
        """Standard error [Pa] of `corrected_shear_stress`, from `total_error` and the area."""
        return abs(self.corrected_shear_stress) * np.hypot(
            self.total_error / self.shear_stress,
            self.area_enhancement_error / self.area_enhancement,
        )

    def to_dataframe(self) -> pd.DataFrame:
        """Return the results as a table: ``value``, ``unit`` and ``meaning`` by name.

        ``interval_low`` and ``interval_high`` are the ends of the 95 % interval. If the error of
        the spectrum is unknown, half the statistical interval is given instead.
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
        """Return HTML sentences on shear stress, error and fit; other numbers are folded away."""
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
    """Return text on the contributions to a 95 % interval of sigma_f, and its quantiles.

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
