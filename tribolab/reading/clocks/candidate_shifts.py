"""Choice between several possible clock shifts, if motion repeats or friction is delayed.

Friction is delayed by slack or builds up over a distance. Velocity classes may then explain it
better one stroke or period away from the true shift. A fit of all effects of the motion
(`clocks.joint`) avoids this error: at a wrong shift the ends of the record and differences
between strokes increase the residual. Another shift replaces the first one only if the likelihood
ratio, for the number of independent residuals, is decisive.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.basis import Basis
from tribolab.reading.clocks.joint import fit_jointly, sampling

_FITTED_SPAN = 0.3  # half width of the fit around each candidate, as share of a stroke's duration


class Candidate(NamedTuple):
    """Candidate shift [s], the unexplained share of the variance, and degrees of freedom.

    `changes` is the number of changes of motion within the force log; any model explains a few of
    them well. `unexplained` is NaN if they are too few for a fit.
    """

    shift: float
    unexplained: float
    freedom: float
    changes: int

    def beats(self, other: Candidate) -> bool:
        """Whether this shift is decisively more likely than another candidate.

        >>> Candidate(0.0, 0.01, 100.0, 8).beats(Candidate(9.0, 0.05, 80.0, 7))
        True
        >>> Candidate(0.0, 0.01, 5.0, 8).beats(Candidate(9.0, 0.05, 80.0, 7))
        False
        >>> Candidate(0.0, 0.01, 100.0, 3).beats(Candidate(9.0, 0.05, 80.0, 7))
        False
        """
        more, likelihood = self._compare(other)
        sees_all = self.changes >= limits.MIN_CHANGES_IN_LOG.value * other.changes
        return bool(
            sees_all
            and more > limits.MIN_MISFIT_OF_RIVAL.value
            and likelihood > limits.MIN_LIKELIHOOD_RATIO.value
        )

    def clears(self, other: Candidate) -> bool:
        """Whether this shift rules out another candidate.

        It does if it is decisively more likely, or if the other one fits worse although it has
        fewer changes of motion within the force log.

        >>> Candidate(0.0, 0.02, 200.0, 12).clears(Candidate(14.0, 0.05, 160.0, 10))
        True
        >>> Candidate(0.0, 0.02, 200.0, 12).clears(Candidate(14.0, 0.05, 160.0, 12))
        False
        """
        ends_tell = other.changes < self.changes and self.surpasses(other)
        return bool(ends_tell or self.beats(other))

    def surpasses(self, other: Candidate) -> bool:
        """Whether this shift is much more likely than another candidate (weaker than `beats`).

        >>> Candidate(0.0, 0.06, 130.0, 12).surpasses(Candidate(1.7, 0.16, 67.0, 12))
        True
        """
        more, likelihood = self._compare(other)
        return bool(
            more > limits.MIN_MISFIT_WITH_FEWER_CHANGES.value
            and likelihood > limits.MIN_LIKELIHOOD_WITH_FEWER_CHANGES.value
        )

    def _compare(self, other: Candidate) -> tuple[float, float]:
        """Return ratio of unexplained shares (other over this), and log likelihood ratio."""
        more = other.unexplained / max(self.unexplained, 1e-12)
        freedom = min(self.freedom, other.freedom)
        return more, 0.5 * freedom * float(np.log(max(more, 1e-12)))

    def outdoes(self, other: Candidate) -> bool:
        """Whether this shift explains more than another, with at least as many changes of motion.

        >>> Candidate(0.0, 0.04, 90.0, 5).outdoes(Candidate(9.0, 0.12, 70.0, 5))
        True
        >>> Candidate(0.0, 0.04, 90.0, 3).outdoes(Candidate(9.0, 0.12, 70.0, 5))
        False
        """
        return self.changes >= other.changes and self.unexplained < other.unexplained


def candidates(force_time: Array, force: Array, basis: Basis, shifts: Array) -> list[Candidate]:
    """Fit the force by all basis functions of the motion, around each of several shifts.

    Parameters
    ----------
    force_time, force
        Force log: its own clock [s] and the friction force.
    basis
        Basis functions of the motion log.
    shifts
        Shifts [s], at least `MIN_DISTANCE_OF_SHIFTS` of a fast stroke's duration apart.
    """
    return [_fitted(force_time, force, basis, shift) for shift in map(float, shifts)]


def _fitted(force_time: Array, force: Array, basis: Basis, shift: float) -> Candidate:
    finest = sampling(force_time, basis, shift)
    answers = fit_jointly(force_time, force, basis, shift, _FITTED_SPAN * basis.stroke, finest)
    at = basis.time[basis.events] + shift
    changes = int(np.count_nonzero((at > force_time[0]) & (at < force_time[-1])))
    if not answers:
        return Candidate(shift, np.nan, 0.0, changes)
    best = min(answers, key=lambda answer: answer.unexplained)
    return Candidate(shift, best.unexplained, best.freedom, changes)


def likeliest(candidates: list[Candidate]) -> Candidate:
    """Return the first candidate, or the best one if it beats the first decisively.

    >>> likeliest([Candidate(0.0, 0.2, 70.0, 8), Candidate(4.5, 0.003, 180.0, 8)]).shift
    4.5
    >>> likeliest([Candidate(0.0, 0.011, 70.0, 8), Candidate(4.5, 0.01, 180.0, 8)]).shift
    0.0
    """
    fitted = [candidate for candidate in candidates if not np.isnan(candidate.unexplained)]
    if not fitted or np.isnan(candidates[0].unexplained):
        return candidates[0]
    best = min(fitted, key=lambda candidate: candidate.unexplained)
    return best if best.beats(candidates[0]) else candidates[0]
