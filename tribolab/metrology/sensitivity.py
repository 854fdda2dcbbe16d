"""Sensitivities of a friction coefficient to the inputs of its uncertainty budget."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tribolab.core.attributes import SegmentAttributes
from tribolab.friction.coefficient.reversal import RESTS, WEIGHED
from tribolab.friction.coefficient.reversal import ZERO as TAKEN_FOR_ZERO
from tribolab.friction.zero.of_run import PAIRED
from tribolab.reading.dialect.uncertainty import Known

_MIN_LOOPS = 3  # pairs of strokes from which the loops themselves determine the drift of the zero
# inputs of the friction coefficient; all others are inputs of the model
_OF_FRICTION = (
    "friction_gain",
    "normal_gain",
    "friction_linearity",
    "normal_linearity",
    "tilt",
    "yaw",
    "cross_talk_friction_from_normal",
    "cross_talk_normal_from_friction",
    "friction_zero",
    "normal_zero",
    "zero_drift",
    "resolution",
)
AMBIGUOUS = "zero_or_tilt"  # effect of unequal loads if tilt and zero cannot be separated


@dataclass(frozen=True)
class SegmentReadings:
    """Quantities that determine the sensitivities, one entry for each segment.

    Parameters
    ----------
    mu, load
        Friction coefficient and mean normal force [N]; the load is NaN if not recorded.
    direction
        +1 or -1.
    both_ways
        Whether the coefficient is the mean of a forward and a backward stroke.
    inverse_load_change
        (1/N_forward - 1/N_backward)/2 of the pair of strokes [1/N]; 0 without a pair.
    middle
        Middle of the loop minus the unloaded zero [N].
    zero_known, normal_zero_known
        Whether the zero of each force was measured in the run; its error is then in the noise.
    drift_known
        Whether the drift of the zero was measured from the loops.
    middle_is
        What the middle of the loops is attributed to: zero or tilt; "" without loops.
    """

    mu: np.ndarray
    load: np.ndarray
    direction: np.ndarray
    both_ways: np.ndarray
    inverse_load_change: np.ndarray
    middle: np.ndarray
    zero_known: np.ndarray
    normal_zero_known: np.ndarray
    drift_known: bool
    middle_is: str


def readings_of(friction: xr.Dataset) -> SegmentReadings:
    """Return the quantities that determine the sensitivities, from a friction result.

    Parameters
    ----------
    friction
        From `tribolab.friction_coefficient` (segment).
    """
    mu = friction["friction_coefficient"].values.astype(float)
    nothing = np.zeros(mu.size)
    load = _values(friction, "normal_force", np.nan)
    pair = _values(friction, "pair", -1).astype(int)
    sign = _values(friction, "direction", 1.0)
    about = SegmentAttributes.from_attrs(friction.attrs)
    offset = about.offset
    both = (pair >= 0) & (offset in PAIRED)
    change, middle = nothing, nothing
    if both.any() and "normal_force" in friction:
        with np.errstate(divide="ignore"):
            change = _pair_means(np.where(load > 0, sign / load, np.nan), pair, both)
        middle = np.where(both, _values(friction, "friction_force_offset", 0.0), 0.0)
    by_itself = offset not in ("", "stated") and not offset.startswith("none")
    return SegmentReadings(
        mu,
        load,
        np.where(sign == 0, 1.0, sign),
        both,
        np.nan_to_num(change),
        middle,
        np.full(mu.size, by_itself) & ~both,
        _values(friction, "normal_force_offset", 0.0) != 0,
        int(pair.max(initial=-1)) + 1 >= _MIN_LOOPS,
        about.middle_of_loop,
    )


def _values(friction: xr.Dataset, name: str, default: float) -> np.ndarray:
    if name in friction:
        return np.asarray(friction[name].values, float)
    return np.full(friction.sizes["segment"], default)


def _pair_means(values: np.ndarray, pair: np.ndarray, both: np.ndarray) -> np.ndarray:
    """Return the mean over both strokes of each pair, for both strokes; 0 without a pair."""
    sums, count = np.zeros((2, int(pair.max(initial=-1)) + 1))
    np.add.at(sums, pair[both], values[both])
    np.add.at(count, pair[both], 1.0)
    return np.where(both, (sums / np.maximum(count, 1))[pair], 0.0)


def contributions(at: SegmentReadings, known: Mapping[str, Known]) -> dict[str, np.ndarray]:
    """Return the signed change of mu for one standard uncertainty of each input.

    Parameters
    ----------
    at
        From `readings_of`.
    known
        Standard uncertainties by the names of `uncertainty.NAMES`; those without effect on the
        friction coefficient are left out.

    Returns
    -------
    dict
        Change for each input (segment) [1]; NaN if the required normal force was not recorded.

    Notes
    -----
    With the true normal force N, the direction s, gains g, tilts alpha and beta, cross-talk c and
    zeros z the channels read ``S_x = (1+g_x)(s mu N cos alpha + N sin alpha + c_xn N) + z_x`` and
    ``S_n = (1+g_n)(N cos beta - s mu N sin beta + c_nx s mu N) + z_n``. Linearised, in one
    direction: ``mu (g_x - g_n) + s (1 + mu^2) tilt + s c_xn - s mu^2 c_nx + s z_x/N - mu z_n/N``.
    With both directions tilt, cross-talk and the zero of friction cancel except for the effect of a
    change of load between the strokes. Hysteresis changes sign with the direction and does not
    cancel. The effect of yaw is mu yaw^2/2, used as its root mean square [1]_ [2]_.

    References
    ----------
    .. [1] Schmitz, Action, Ziegert, Sawyer (2005), J. Tribol. 127, 673-678. doi:10.1115/1.1843853
    .. [2] Burris and Sawyer (2009), Tribol. Lett. 35, 17-23. doi:10.1007/s11249-009-9438-2
    """
    mu, one_way = at.mu, ~at.both_ways
    per_load = 1 / np.where(at.load > 0, at.load, np.nan)
    u = {name: entry.standard for name, entry in known.items()}
    zero = np.where(one_way & ~at.zero_known, at.direction * per_load, 0.0)
    normal_zero = np.where(at.normal_zero_known, 0.0, -mu * per_load)
    drift = np.where(at.both_ways & (not at.drift_known), per_load / 2, 0.0)
    sensitivity = {
        "friction_gain": mu,
        "normal_gain": -mu,
        "friction_linearity": per_load,
        "normal_linearity": -mu * per_load,
        "tilt": np.where(one_way, at.direction * (1 + mu**2), 0.0),
        "yaw": -mu * np.sqrt(0.75) * u.get("yaw", 0.0),
        "cross_talk_friction_from_normal": np.where(one_way, at.direction, 0.0),
        "cross_talk_normal_from_friction": np.where(one_way, -at.direction * mu**2, 0.0),
        "friction_zero": zero,
        "normal_zero": normal_zero,
        "zero_drift": drift,
        "resolution": np.where(one_way, 1.0, np.sqrt(0.5)) * per_load,
    }
    parts = {name: sensitivity[name] * u[name] for name in _OF_FRICTION if name in u}
    return parts | _load_remainder(at, u, parts)


def _load_remainder(
    at: SegmentReadings, u: Mapping[str, float], parts: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Return the effect of tilt and zero that remains if the load differs between the strokes.

    If both are stated and no rest separates them, the middle of the loop was divided between them,
    and the remainder of each has the variance a b/(a + b).
    """
    if at.middle_is in ("", RESTS):
        return {}
    if at.middle_is == WEIGHED:
        tilting, zero = at.load * u.get("tilt", 0.0), u.get("friction_zero", 0.0)
        force = tilting * zero / np.sqrt(np.maximum(tilting**2 + zero**2, 1e-300))
        left = np.where(at.both_ways, np.nan_to_num(force) * at.inverse_load_change, 0.0)
        return {"tilt": parts.get("tilt", 0.0) + left}
    if at.middle_is != TAKEN_FOR_ZERO or "friction_zero" in u:
        return {}
    # rectangular distribution from zero to the full effect
    left = np.abs(at.middle * at.inverse_load_change) / np.sqrt(3)
    return {AMBIGUOUS: left} if left.any() else {}
