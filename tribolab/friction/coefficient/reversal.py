"""Friction from both sliding directions, corrected for a tilt between force cell and contact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from tribolab.friction.zero import limits
from tribolab.friction.zero.parts import ZeroReference
from tribolab.friction.zero.rests import Zeros

# Interpretations of the middle of a loop
ZERO, RESTS, WEIGHED = "a zero", "told by rests without load", "weighed by what is stated of both"


class Reversal(NamedTuple):
    """Interpretation of the middle of the friction loops: tilt or zero.

    Parameters
    ----------
    pair
        Number of the pair of each segment, -1 for none (segment).
    tilted
        Part of the loop's middle that is attributed to the tilt, in the unit of the friction
        signal (segment).
    most
        Largest part that can be due to the tilt: the middle minus the unloaded zero (segment).
    middle
        Interpretation of the middle: `ZERO`, `RESTS` or `WEIGHED`; "" without a loop.
    """

    pair: np.ndarray
    tilted: np.ndarray
    most: np.ndarray
    middle: str

    def remove_tilt(
        self, ratio: np.ndarray, sign: np.ndarray, load: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the friction coefficients without tilt, and the tilt [rad]; NaN without a pair.

        Parameters
        ----------
        ratio
            Mean ratio of the forces of each segment, including the tilt (segment).
        sign, load
            Direction and mean normal force of each segment.

        Notes
        -----
        The contact force is at the angle atan(mu) to the normal. A cell turned by the tilt measures
        tan(atan(mu) + tilt) forward and tan(atan(mu) - tilt) backward at any load, so that mu
        is the tangent of the mean of the two angles. If the middle of the loop was attributed to
        the zero, the tilt returned is the one that would explain it.

        Examples
        --------
        >>> tilted = np.tan(np.radians([2.0, 2.0]))
        >>> strokes = Reversal(np.array([0, 0]), tilted, tilted, RESTS)
        >>> both = np.tan(np.arctan(1.4) + np.radians([2.0, -2.0]))
        >>> mu, tilt = strokes.remove_tilt(both, np.array([1, -1]), np.ones(2))
        >>> both.round(4), mu.round(6), np.degrees(tilt).round(6)
        (array([1.5087, 1.3015]), array([1.4, 1.4]), array([2., 2.]))
        """
        paired = self.pair >= 0
        if not paired.any():
            return ratio, np.full(ratio.size, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            all_of_it = ratio + sign * (self.most - self.tilted) / load
        middle = _pair_means(np.arctan(ratio), self.pair)
        tilt = _pair_means(sign * np.arctan(all_of_it), self.pair)
        # unchanged without tilt, or if one of the strokes has no coefficient
        turned = paired & (self.tilted != 0) & np.isfinite(middle)
        return np.where(turned, np.tan(middle), ratio), tilt


def _pair_means(values: np.ndarray, pair: np.ndarray) -> np.ndarray:
    """Return for each segment the mean over the two strokes of its pair; NaN without a pair."""
    paired = pair >= 0
    sums = np.zeros(int(pair.max(initial=-1)) + 1)
    np.add.at(sums, pair[paired], values[paired] / 2)
    return np.where(paired, sums[pair], np.nan)


def reversal_of(
    zero: ZeroReference,
    pair: np.ndarray,
    load: np.ndarray,
    time: np.ndarray,
    ratio: np.ndarray,
    rests: Zeros | None,
    stated: Mapping[str, Mapping[str, Any]],
) -> Reversal:
    """Separate tilt and zero in the middles of the loops.

    Parameters
    ----------
    zero
        Source of the zero; tilt and zero are separated only for the half loop.
    pair, load, time, ratio
        Number of the pair, mean normal force, mean time [s], and friction over load, of either sign
        (segment).
    rests
        Zeros from rests without load, which a tilt does not affect.
    stated
        Stated calibration, by name: standard uncertainties of ``tilt`` [rad] and ``friction_zero``
        [N].

    Notes
    -----
    At equal loads a zero and a tilt shift the middle of a loop alike. If the load changes by a
    share d between the strokes, a tilt mistaken for a zero leaves an error tilt d/2, and a zero
    mistaken for a tilt leaves zero/load d/2. Unloaded rests separate the two, if they were recorded
    before and after the strokes or the loads differ, and if the angle is plausible and constant in
    time: else the zero has drifted since the rest. Without rests the middle is divided in
    proportion to the stated variances, (load tilt)^2 and zero^2: with only one of them stated, all
    of it is attributed to that one.
    """
    members = np.where((pair >= 0) & np.isfinite(zero.half_loop), pair, -1)
    nothing = np.zeros(pair.size)
    if zero.method != "half loop" or not (members >= 0).any():
        return Reversal(np.full(pair.size, -1), nothing, nothing, "")
    apart = zero.value - (rests.at(time)[0] if rests is not None else 0.0)
    most = np.nan_to_num(_pair_means(apart, members))
    if rests is not None and _is_tilt(apart, members, load, time, ratio, rests):
        return Reversal(members, most, most, RESTS)
    if rests is not None:  # the zero drifted since the rest, or the cell is slightly tilted
        return Reversal(members, nothing, most, ZERO)
    tilt, offset = (float(stated.get(n, {}).get("standard", 0)) for n in ("tilt", "friction_zero"))
    if not tilt:
        return Reversal(members, nothing, most, ZERO)
    tilting = (np.nan_to_num(_pair_means(load, members)) * tilt) ** 2
    share = np.divide(tilting, tilting + offset**2, out=np.zeros(pair.size), where=tilting > 0)
    return Reversal(members, share * most, most, WEIGHED)


def _is_tilt(
    apart: np.ndarray,
    members: np.ndarray,
    load: np.ndarray,
    time: np.ndarray,
    ratio: np.ndarray,
    rests: Zeros,
) -> bool:
    """Return whether the difference between middles and rests is a tilt, not a drifting zero."""
    paired = (members >= 0) & np.isfinite(apart) & (load > 0)
    if not paired.any():
        return False
    between = bool(rests.around(time[paired]).all()) and rests.time.size > 1
    several = load[paired].max() > limits.LOADS_DIFFER.value * load[paired].min()
    if not (between or several):
        return False
    # a cell tilted by an angle t shifts the middle by t times the load, or by t (1 + mu^2) times
    # the load if the strokes are weighted by loads measured with the tilt
    ways = (np.zeros(ratio.size), ratio**2)
    felt = [_pair_means(load, members) * (1 + _pair_means(way, members)) for way in ways]
    at = _pair_means(time, members)[paired]
    return any(_is_an_angle((_pair_means(apart, members) / own)[paired], at) for own in felt)


def _is_an_angle(angle: np.ndarray, time: np.ndarray) -> bool:
    """Return whether the angles of the pairs are plausible and constant in time."""
    mean, moment = float(np.mean(angle)), time - time.mean()
    slope = float(moment @ angle) / max(float(moment @ moment), 1e-300)
    steady = abs(slope) * float(np.ptp(time)) <= limits.TILT_CHANGES.value * abs(mean)
    return steady and abs(mean) <= limits.MAX_SAMPLE_TILT.value
