"""Probability that a diffusing quantity first reaches a moving absorbing boundary.

The stress at a point of a rough contact diffuses as finer roughness is included: "time" is its
variance, and contact is lost where the stress falls to the boundary (zero without adhesion, else a
detachment stress). The surviving share is the apparent contact area.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr

from tribolab.core.errors import AnalysisError


@dataclass(frozen=True)
class Diffusion:
    """Diffusion on given nodes in time, with the weights of its Volterra equation.

    Notes
    -----
    The boundary is constant within a step. Then the diagonal of the Volterra equation is exactly
    1/2 for any speed of the boundary, and steps are solved successively without loss of digits;
    with the boundary at the nodes the diagonal vanishes and the sum is unstable.
    """

    time: np.ndarray  # (n), starts with 0, never decreases
    inverse_root: np.ndarray  # 1/sqrt(t_i - middle of step j) for node i, step j < i, (n, n - 1)
    runs: np.ndarray  # whether time increases in a step (n - 1)

    @classmethod
    def over(cls, time: ArrayLike) -> Diffusion:
        """Return the diffusion on given nodes in time.

        Raises
        ------
        AnalysisError
            If time does not start with 0, decreases, or never passes.
        """
        t = np.asarray(time, dtype=float)
        good = t.ndim == 1 and t.size > 1 and t[0] == 0 and (np.diff(t) >= 0).all()
        if not (good and 0 < t[-1] < np.inf):
            raise AnalysisError(
                "first passage: time must start with 0, never decrease and end above 0; it is "
                f"{np.array2string(t, threshold=6, edgeitems=2, precision=4)}"
            )
        runs = np.diff(t) > 1e-14 * t[-1]
        middle = (t[1:] + t[:-1]) / 2
        gap = np.maximum(t[:, None] - middle[None, :], 1e-16 * t[-1])
        return cls(t, 1 / np.sqrt(gap), runs)

    def lost(
        self,
        step: int,
        level: np.ndarray,
        start: np.ndarray,
        levels: np.ndarray,
        losses: np.ndarray,
    ) -> np.ndarray:
        """Return the probability of reaching the boundary during one step, given all earlier steps.

        Parameters
        ----------
        step
            Index of the step, which ends at node ``step + 1``.
        level
            Height of the boundary in this step (k).
        start
            Start of the diffusion (k).
        levels, losses
            Heights and losses of the earlier steps (step or more, k).

        Returns
        -------
        numpy.ndarray
            The loss (k).

        Notes
        -----
        Each path at or below the boundary b_i at time t_i has reached it before, and has diffused
        from there during the remaining time: Phi((b_i - p)/sqrt(t_i)) = sum_j dF_j Phi((b_i -
        b_j)/sqrt(t_i - t_jm)), solved for dF_i.
        """
        if not self.runs[step]:
            return np.zeros_like(level)
        below = ndtr((level - start) / np.sqrt(self.time[step + 1]))
        if step:
            weight = ndtr((level - levels[:step]) * self.inverse_root[step + 1, :step, None])
            below -= np.einsum("jk,jk->k", weight, losses[:step])
        # rounding can make a tiny probability negative
        return np.maximum(2 * below, 0.0)
