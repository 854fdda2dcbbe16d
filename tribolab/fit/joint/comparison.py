"""Comparison of several models of the same curves by evidence and by prediction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tribolab.core.errors import AnalysisError, shown
from tribolab.core.untyped import Arguments
from tribolab.fit import limits
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.result import JointFit

POWER_LAW = "power law of speed and load"
CONSTANT = "constant shear stress"
WITHOUT_FACTORS = "no friction factors"


@dataclass(frozen=True)
class ComparedModel:
    """One model, compared with the reference model.

    Parameters
    ----------
    name
        Name of the model.
    evidence
        ln of the odds of this model against the reference, from all points.
    prediction
        ln of the predictive density of a load's points given all other points, summed over the
        loads, minus the same sum of the reference; NaN for one load.
    prediction_error
        Standard error of `prediction`, from the scatter between loads; NaN for fewer than three.
    shear_stress, shear_stress_low, shear_stress_high
        sigma_0 [Pa] of the first surface under the model, and its 95 % interval.
    words
        Conclusion in words.
    """

    name: str
    evidence: float
    prediction: float
    prediction_error: float
    shear_stress: float
    shear_stress_low: float
    shear_stress_high: float
    words: str


@dataclass(frozen=True, eq=False)
class ModelComparison:
    """Joint fits of the same curves under several models.

    Parameters
    ----------
    reference
        Name of the model with which the others are compared.
    models
        In the order given, the reference first.
    fits
        The fit of each model, by its name.
    """

    reference: str
    models: tuple[ComparedModel, ...]
    fits: Mapping[str, JointFit]


def usual_variants(priors: JointPriors) -> dict[str, Arguments]:
    """Return the default set of models to compare."""
    return {
        POWER_LAW: {"priors": priors},
        CONSTANT: {"priors": replace(priors, speed_exponent=0.0, load_exponent=0.0)},
        WITHOUT_FACTORS: {"friction_factors": False},
    }


def compared(fits: Mapping[str, JointFit]) -> ModelComparison:
    """Compare fits of the same points with the first of these fits.

    Raises
    ------
    AnalysisError
        If there is no fit, or the fits are not of the same points.
    """
    if not fits:
        raise AnalysisError("variants: no model is named")
    reference, first = next(iter(fits.items()))
    models = []
    for name, fit in fits.items():
        if fit.points.sizes != first.points.sizes:
            raise AnalysisError(
                f"{shown(name)}: it is of other points than {shown(reference)}, and only models of "
                "the same points can be compared"
            )
        evidence = fit.log_evidence - first.log_evidence
        apart = np.array([fit.left_out[load] - first.left_out[load] for load in first.left_out])
        prediction = float(apart.sum()) if apart.size > 1 else np.nan
        error = float(apart.std(ddof=1) * np.sqrt(apart.size)) if apart.size > 2 else np.nan
        stress = fit.marginals[0]
        words = "the reference"
        if name != reference:
            words = _conclude((name, _free(fit)), (reference, _free(first)), evidence, prediction)
        models.append(
            ComparedModel(
                name, evidence, prediction, error, stress.value, stress.low, stress.high, words
            )
        )
    return ModelComparison(reference, tuple(models), dict(fits))


def _free(fit: JointFit) -> int:
    """Return the number of free parameters of a fit."""
    return sum(np.isfinite(marginal.reduction) for marginal in fit.marginals)


def _conclude(
    model: tuple[str, int], reference: tuple[str, int], evidence: float, prediction: float
) -> str:
    """Return the verdict from the more conservative of evidence and prediction.

    Parameters
    ----------
    model, reference
        Name, and number of free parameters.
    evidence, prediction
        As in `ComparedModel`.

    Examples
    --------
    >>> _conclude(("b", 4), ("a", 3), 6.0, 4.0), _conclude(("b", 4), ("a", 3), -2.0, -5.0)
    ('the data need b', 'a is enough')
    >>> _conclude(("b", 4), ("a", 3), 6.0, -4.0), _conclude(("b", 3), ("a", 3), 2.0, 6.0)
    ('the data do not tell b from a', 'the data lean to b')
    >>> _conclude(("b", 2), ("a", 3), -6.0, -4.0), _conclude(("b", 3), ("a", 3), -2.0, -6.0)
    ('the data contradict b', 'the data lean to a')
    """
    criteria = np.array([evidence, prediction])
    criteria = criteria[np.isfinite(criteria)]
    strength = float(np.abs(criteria).min())
    if strength < limits.MIN_LN_ODDS.value or np.ptp(np.sign(criteria)) > 0:
        return f"the data do not tell {model[0]} from {reference[0]}"
    wanted, other = (model, reference) if evidence > 0 else (reference, model)
    if wanted[1] < other[1]:
        return f"{wanted[0]} is enough"
    if strength < limits.STRONG_LN_ODDS.value:
        return f"the data lean to {wanted[0]}"
    return f"the data need {model[0]}" if wanted == model else f"the data contradict {model[0]}"
