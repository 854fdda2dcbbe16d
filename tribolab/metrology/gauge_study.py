"""Gauge study: variance between parts, between appraisers and between trials."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from tribolab.core.aliases import Array
from tribolab.core.errors import AnalysisError

_POOLED_ABOVE = 0.25  # p value of the interaction above which it is counted as repeatability
_CATEGORIES = math.sqrt(2)  # factor of s_parts/s_gauge in the number of distinct categories


@dataclass(frozen=True)
class GaugeStudy:
    """Variance components of a balanced gauge study, in squared units of the value.

    Parameters
    ----------
    repeatability, appraisers, interaction, parts
        Variances: of trials, between appraisers, of appraisers with parts, between parts.
    interaction_p_value
        p value of the F test of the interaction.
    pooled
        Whether the insignificant interaction was pooled with the repeatability.
    """

    repeatability: float
    appraisers: float
    interaction: float
    parts: float
    interaction_p_value: float
    pooled: bool

    @property
    def reproducibility(self) -> float:
        """Variance between appraisers, including the interaction with parts."""
        return self.appraisers + self.interaction

    @property
    def gauge(self) -> float:
        """Variance of the measurement: repeatability plus reproducibility."""
        return self.repeatability + self.reproducibility

    @property
    def study_variation(self) -> float:
        """Ratio of the standard deviation of the measurement to that of all values."""
        return math.sqrt(self.gauge / (self.gauge + self.parts))

    @property
    def categories(self) -> int:
        """Number of categories of parts that the gauge can distinguish (ndc)."""
        return int(_CATEGORIES * math.sqrt(self.parts / self.gauge)) if self.gauge else 0


def gauge_study(values: ArrayLike) -> GaugeStudy:
    """Return the variance components of a balanced crossed study, by analysis of variance.

    Parameters
    ----------
    values
        (part, appraiser, trial), two of each or more. In a laboratory a part is a specimen and
        condition, an appraiser an operator, mount, day or instrument, a trial a run.

    Raises
    ------
    AnalysisError
        If there are fewer than two parts, appraisers or trials, or values are missing.

    Notes
    -----
    The interaction is pooled with the repeatability if its F test gives p > 0.25. Negative
    components are set to zero.

    References
    ----------
    AIAG (2010), Measurement Systems Analysis, 4th edition.

    Examples
    --------
    >>> study = gauge_study([[[1.0, 1.2], [1.1, 1.3]], [[2.0, 2.2], [2.1, 2.3]]])
    >>> round(study.parts, 3), round(study.repeatability, 3), study.pooled
    (0.496, 0.016, True)
    """
    y = _check_balance(values)
    parts, appraisers, trials = y.shape
    grand, of_part, of_appraiser = y.mean(), y.mean(axis=(1, 2)), y.mean(axis=(0, 2))
    cell = y.mean(axis=2)
    squares = {
        "part": appraisers * trials * ((of_part - grand) ** 2).sum(),
        "appraiser": parts * trials * ((of_appraiser - grand) ** 2).sum(),
        "both": trials * ((cell - of_part[:, None] - of_appraiser + grand) ** 2).sum(),
        "trial": ((y - cell[:, :, None]) ** 2).sum(),
    }
    freedom_both, freedom_trial = (parts - 1) * (appraisers - 1), parts * appraisers * (trials - 1)
    mean_both, mean_trial = squares["both"] / freedom_both, squares["trial"] / freedom_trial
    chance = (
        float(special.fdtrc(freedom_both, freedom_trial, mean_both / mean_trial))
        if (mean_trial > 0)
        else 0.0
    )
    pooled = chance > _POOLED_ABOVE
    if pooled:
        repeatability = (squares["both"] + squares["trial"]) / (freedom_both + freedom_trial)
        noise, interaction = repeatability, 0.0
    else:
        repeatability, noise = mean_trial, mean_both
        interaction = max(0.0, (mean_both - mean_trial) / trials)
    between_parts = (squares["part"] / (parts - 1) - noise) / (appraisers * trials)
    between = (squares["appraiser"] / (appraisers - 1) - noise) / (parts * trials)
    return GaugeStudy(
        float(repeatability),
        max(0.0, float(between)),
        float(interaction),
        max(0.0, float(between_parts)),
        chance,
        pooled,
    )


def _check_balance(values: ArrayLike) -> Array:
    y = np.asarray(values, dtype=float)
    if y.ndim != 3 or min(y.shape) < 2 or not np.isfinite(y).all():
        raise AnalysisError(
            "a gauge study wants two parts, appraisers and trials or more, and no value missing; "
            f"got {' x '.join(map(str, y.shape))}"
        )
    return y
