"""Result of a joint fit: marginals, correlations, and a verdict in words."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.core.wording import many, number, percent
from tribolab.fit import limits

_NAMES = {  # by parameter: its unit, and its name in words
    "shear_stress": ("Pa", "shear stress"),
    "speed_exponent": ("1", "exponent of speed"),
    "load_exponent": ("1", "exponent of load"),
    "viscosity": ("Pa s", "viscosity"),
    "dry_over_wet": ("1", "dry over wet shear stress"),
    "level": ("1", "error common to a level"),
    "correlated": ("1", "error that neighbouring speeds share"),
}


@dataclass(frozen=True)
class Marginal:
    """Marginal posterior distribution of one parameter of a joint fit.

    Parameters
    ----------
    name
        ``shear_stress`` (sigma_0), ``speed_exponent`` (n), ``load_exponent`` (m), ``viscosity``,
        ``dry_over_wet`` shear stress; ``level`` (tau) and ``correlated`` (kappa) error.
    surface
        Name of the surface; "" if the parameter applies to all, or there is only one.
    value, low, high
        Median and ends of the 95 % interval, in SI.
    prior_low, prior_high
        Ends of the 95 % interval of the prior.
    reduction
        Reduction [1] of the prior's standard deviation by the data: 0 if they contain no
        information; NaN for a fixed parameter.
    """

    name: str
    surface: str
    value: float
    low: float
    high: float
    prior_low: float
    prior_high: float
    reduction: float

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return _NAMES[self.name][0]

    @property
    def identified(self) -> str:
        """Whether data fix the parameter: "yes", "weakly", "not identified" or "held fixed"."""
        if np.isnan(self.reduction):
            return "held fixed"
        if self.reduction < limits.MIN_REDUCTION_OF_PRIOR.value:
            return "not identified"
        return "weakly" if self.reduction < limits.WEAK_REDUCTION_OF_PRIOR.value else "yes"

    @property
    def words(self) -> str:
        """Name of the parameter in words."""
        words = _NAMES[self.name][1]
        return f"{words} of {self.surface}" if self.surface else words


@dataclass(frozen=True, eq=False)
class JointFit:
    """Result of a joint fit of friction against speed at several loads.

    Parameters
    ----------
    marginals
        Marginals of all parameters: first those of `correlation`, then the sizes of the shared
        errors.
    correlation
        Posterior correlation of all other parameters than those sizes (parameter, parameter).
    reference_speed, reference_load
        v0 [m/s] and F0 [N/m], at which the shear stress is sigma_0.
    log_evidence
        ln of the probability density of the points under this model and its priors.
    left_out
        By name of each wet curve, ln of the probability density of its points given all other
        curves.
    points
        Over (point): ``surface``, ``curve``, ``run``, ``sliding_speed``, ``friction_coefficient``
        with ``_sem`` and ``_model``; ``relative_residual``, ln of measured over computed friction;
        ``shared_residual``, its part attributed to level and neighbouring speeds.
    curves
        Over (curve, sliding_speed): ``friction_coefficient`` of the model with ``_low`` and
        ``_high``, ends of its 95 % band due to the parameters, ``_load_low`` and ``_load_high``,
        including the errors common to a load's points; ``load`` [N/m] and ``surface`` (curve).
    common_error
        Relative standard error [1] of the shear stress common to all loads, included in the
        interval.
    spectrum_error
        Surfaces whose intervals include the error of the spectrum.
    skipped
        Number of points left out because their friction is not above zero.
    """

    marginals: tuple[Marginal, ...]
    correlation: np.ndarray = field(repr=False)
    reference_speed: float
    reference_load: float
    log_evidence: float
    left_out: dict[str, float]
    points: xr.Dataset = field(repr=False)
    curves: xr.Dataset = field(repr=False)
    common_error: float
    spectrum_error: tuple[str, ...]
    skipped: int

    def marginal(self, name: str, surface: str = "") -> Marginal:
        """Return the marginal of a parameter, for one surface if there are several.

        Raises
        ------
        KeyError
            If there is no such parameter.
        """
        for marginal in self.marginals:
            if marginal.name == name and (not surface or marginal.surface in ("", surface)):
                return marginal
        raise KeyError(f"{name} {surface}".strip())

    @property
    def described(self) -> bool:
        """Whether the model describes the curves: the correlated error is below a tenth."""
        return self.marginal("correlated").value <= limits.MAX_CORRELATED_ERROR.value

    def table(self) -> pd.DataFrame:
        """Return a table of the parameters: median, 95 % interval, prior interval, and verdict."""
        rows = [
            {
                "parameter": marginal.name,
                "surface": marginal.surface,
                "value": marginal.value,
                "low": marginal.low,
                "high": marginal.high,
                "unit": marginal.unit,
                "prior_low": marginal.prior_low,
                "prior_high": marginal.prior_high,
                "told": marginal.reduction,
                "identified": marginal.identified,
            }
            for marginal in self.marginals
        ]
        return pd.DataFrame(rows).set_index("parameter")

    def correlations(self) -> pd.DataFrame:
        """Return the posterior correlation of every pair of parameters."""
        names = [marginal.words for marginal in self.marginals[: len(self.correlation)]]
        return pd.DataFrame(self.correlation, names, names)

    @property
    def words(self) -> list[str]:
        """Sentences on parameters that the data do not determine, and on correlated parameters."""
        return [
            *(
                _undetermined(marginal)
                for marginal in self._physical
                if marginal.reduction < limits.WEAK_REDUCTION_OF_PRIOR.value
            ),
            *(_contradiction(marginal) for marginal in self._physical if _is_beyond(marginal)),
            *self._correlated(),
            *self._misfit(),
        ]

    @property
    def _physical(self) -> tuple[Marginal, ...]:
        """Marginals of the physical parameters, without the sizes of the shared errors."""
        return self.marginals[: len(self.correlation)]

    def _correlated(self) -> list[str]:
        """Return sentences on pairs of parameters that the data hardly separate."""
        texts = []
        for i, j in np.argwhere(
            np.triu(np.abs(self.correlation), 1) > limits.MAX_CORRELATION.value
        ):
            first, second = self.marginals[i], self.marginals[j]
            texts.append(
                f"{first.words} and {second.words} are hardly told apart: their errors correlate "
                f"by {number(self.correlation[i, j], 2)}"
            )
        return texts

    def _misfit(self) -> list[str]:
        """Return sentences on a poor fit of the model, and on omitted points."""
        texts = []
        if not self.described:
            off = percent(self.marginal("correlated").value)
            texts.append(
                f"the model does not describe these curves: neighbouring speeds are off together "
                f"by {off}, so the intervals say how such a model would have to be bent"
            )
        if self.skipped:
            texts.append(
                f"{many(self.skipped, 'point')} with a friction not above zero "
                f"{'is' if self.skipped == 1 else 'are'} not taken"
            )
        return texts

    def _repr_html_(self) -> str:
        """Return HTML with median and interval of every parameter, and the sentences."""
        rows = "".join(
            f"<tr><th>{marginal.words}</th><td>{in_words(marginal)}</td>"
            f"<td>{marginal.identified}</td></tr>"
            for marginal in self.marginals
        )
        items = "".join(f"<li>{sentence}</li>" for sentence in self.words)
        table = self.table().to_html(float_format=lambda value: f"{value:.4g}")
        return (
            "<table><thead><tr><th></th><th>median, 95 % interval</th><th>identified</th></tr>"
            f"</thead><tbody>{rows}</tbody></table><ul>{items}</ul>"
            f"<details><summary>all numbers in SI</summary>{table}</details>"
        )


def in_words(marginal: Marginal) -> str:
    """Return median and 95 % interval as text.

    Examples
    --------
    >>> in_words(Marginal("shear_stress", "", 0.84e6, 0.81e6, 0.87e6, 1e5, 3e6, 0.98))
    '0.84 MPa (0.81 to 0.87)'
    """
    value, low, high = marginal.value, marginal.low, marginal.high
    if marginal.name in ("level", "correlated"):
        return f"{percent(value)} ({number(100 * low, 2)} to {number(100 * high, 2)})"
    factor, unit = (1e-6, " MPa") if marginal.unit == "Pa" else (1.0, f" {marginal.unit}")
    unit = "" if marginal.unit == "1" else unit
    return f"{number(factor * value)}{unit} ({number(factor * low)} to {number(factor * high)})"


def _is_beyond(marginal: Marginal) -> bool:
    """Return whether a parameter lies outside the interval of its prior."""
    return not marginal.prior_low <= marginal.value <= marginal.prior_high


def _contradiction(marginal: Marginal) -> str:
    """Return a sentence on a conflict between data and prior of a parameter."""
    before = replace(marginal, low=marginal.prior_low, high=marginal.prior_high)
    _, _, ends = in_words(before).partition("(")
    return (
        f"{marginal.words}: {in_words(marginal)} lies outside of what was thought possible "
        f"beforehand, {ends.rstrip(')')}; check what was stated"
    )


def _undetermined(marginal: Marginal) -> str:
    """Return a sentence on a parameter that the data hardly determine."""
    if marginal.reduction < limits.MIN_REDUCTION_OF_PRIOR.value:
        return (
            f"{marginal.words}: not identified; the interval is what was assumed beforehand, "
            f"{in_words(marginal)}"
        )
    return f"{marginal.words}: the data tell little of it, {in_words(marginal)}"
