"""Record of a joint fit: parameters, statements, and compared models."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from tribolab.records.annotations import means, one_of
from tribolab.records.parts import HasStatus

if TYPE_CHECKING:
    from tribolab.fit.joint.comparison import ModelComparison
    from tribolab.fit.joint.result import JointFit


@dataclass(frozen=True)
class JointParameter:
    """Estimate of one parameter, in the stated unit."""

    parameter: str
    value: Annotated[float, means("median")]
    low: Annotated[float, means("lower end of the 95 % interval")]
    high: float
    unit: str
    prior_low: Annotated[float, means("lower end of the prior interval")]
    prior_high: float
    told: Annotated[
        float | None,
        means("reduction of the prior's standard deviation by the data; null if fixed"),
    ]
    identified: Annotated[str, one_of("yes", "weakly", "not identified", "held fixed")]
    words: Annotated[str, means("name, median and interval in words")]
    surface: Annotated[str, means("surface, if several are fitted")] = ""


@dataclass(frozen=True)
class JointModelRow:
    """Comparison of one model of the same curves with the first."""

    model: str
    evidence: Annotated[
        float, means("ln(Bayes factor) relative to the first model, from all points")
    ]
    prediction: Annotated[
        float | None,
        means("ln of the odds from cross-validation over loads; null for one load"),
    ]
    prediction_error: float | None
    shear_stress_Pa: float
    shear_stress_low_Pa: float
    shear_stress_high_Pa: float
    words: str


@dataclass(frozen=True)
class JointCorrelation:
    """Posterior correlation of two parameters."""

    first: str
    second: str
    correlation: float


@dataclass(frozen=True)
class JointRecord(HasStatus):
    """Joint fit of all loads of one or several surfaces in one liquid.

    Parameters
    ----------
    name
        Name of the fit and of its data file.
    surface, medium
        Surface and medium; several surfaces are joined by "and".
    curves
        Names of the measured curves.
    status, reason
        "done", or "failed" and why.
    file
        Data file relative to the results folder; "" for a failed fit.
    reference_speed_m_s, reference_load_N_m
        Speed and load to which the shear stress refers.
    described
        Whether the model describes the curves.
    parameters, correlations
        The posterior.
    sentences
        Statements on undetermined and correlated parameters.
    models
        Comparison of several models; the first is that of the parameters.
    """

    name: str
    surface: str
    medium: str
    curves: tuple[str, ...]
    status: Annotated[str, one_of("done", "failed")]
    reason: Annotated[str, means("reason of the failure, or empty")] = ""
    file: str = ""
    reference_speed_m_s: float | None = None
    reference_load_N_m: float | None = None
    described: bool = False
    parameters: tuple[JointParameter, ...] = ()
    correlations: tuple[JointCorrelation, ...] = ()
    sentences: tuple[str, ...] = ()
    models: tuple[JointModelRow, ...] = ()


def parameter_rows(fit: JointFit) -> tuple[JointParameter, ...]:
    """Return the posterior of each parameter of a fit, one row each."""
    from tribolab.fit.joint.result import in_words  # imported late for a quick start

    return tuple(
        JointParameter(
            parameter=marginal.name,
            surface=marginal.surface,
            value=marginal.value,
            low=marginal.low,
            high=marginal.high,
            unit=marginal.unit,
            prior_low=marginal.prior_low,
            prior_high=marginal.prior_high,
            told=_known(marginal.reduction),
            identified=marginal.identified,
            words=f"{marginal.words} {in_words(marginal)}",
        )
        for marginal in fit.marginals
    )


def correlation_rows(fit: JointFit) -> tuple[JointCorrelation, ...]:
    """Return the correlation of every two parameters, one row each."""
    names = [" of ".join(filter(None, (m.name, m.surface))) for m in fit.marginals]
    size = len(fit.correlation)
    return tuple(
        JointCorrelation(names[i], names[j], float(fit.correlation[i, j]))
        for i in range(size)
        for j in range(i + 1, size)
    )


def model_rows_of_comparison(comparison: ModelComparison) -> tuple[JointModelRow, ...]:
    """Return evidence for each model, one row each."""
    return tuple(
        JointModelRow(
            model=model.name,
            evidence=model.evidence,
            prediction=_known(model.prediction),
            prediction_error=_known(model.prediction_error),
            shear_stress_Pa=model.shear_stress,
            shear_stress_low_Pa=model.shear_stress_low,
            shear_stress_high_Pa=model.shear_stress_high,
            words=model.words,
        )
        for model in comparison.models
    )


def _known(value: float) -> float | None:
    return None if value != value else float(value)
