"""Force samples near the changes of motion, on which a clock shift depends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.core.aliases import Array
from tribolab.reading.clocks.basis import Basis

_FITTED_SAMPLES = 2000  # force samples used in one fit
_MAX_EVENTS = 60
DRIFT_FUNCTIONS = 8  # number of hat functions of time that describe the drift


def _samples_near_changes(
    force_time: Array, basis: Basis, shift: float, half: float
) -> NDArray[np.int64]:
    """Return indices of force samples around the changes of motion, denser near them."""
    events = basis.time[basis.events] + shift
    inside = (events > force_time[0] + half) & (events < force_time[-1] - half)
    inside[inside] = np.arange(inside.sum()) % (1 + inside.sum() // _MAX_EVENTS) == 0
    events, around = events[inside], basis.around[inside] + shift
    if not len(events):
        return np.zeros(0, dtype=np.int64)
    each = max(20, _FITTED_SAMPLES // len(events)) // 2  # samples before each change, and after it
    k = np.searchsorted(force_time, events)
    a, b = np.searchsorted(force_time, around.T)
    count = np.stack([b - k, k - a])  # (after or before, event)
    # evenly within the span, then increasingly sparse
    flat = np.searchsorted(force_time, events + 2.0 * half) - k
    scale = np.maximum(np.minimum(flat, count), 4)
    u = np.linspace(0.0, np.arcsinh(np.maximum(count, 1) / scale), each, axis=-1)
    thinned, all_of_few = (scale[:, :, None] * np.sinh(u)).astype(np.int64), np.arange(each)
    many = (count > each)[:, :, None]
    places = k[:, None] + np.array([1, -1])[:, None, None] * np.where(many, thinned, all_of_few)
    chosen = _without_repeats(np.sort(places[many | (all_of_few < count[:, :, None])]))
    good = (chosen >= 0) & (chosen < len(force_time))
    chosen = chosen[good]
    first = max(basis.time[0] + shift + half, force_time[0])
    last = min(basis.time[-1] + shift - half, force_time[-1])
    return chosen[(force_time[chosen] >= first) & (force_time[chosen] <= last)]


def _without_repeats(increasing: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a sorted array without repeated values, faster than `numpy.unique`."""
    if not len(increasing):
        return increasing
    return increasing[np.diff(increasing, prepend=-1 - abs(int(increasing[0]))) != 0]


class ForceSamples(NamedTuple):
    """Samples of the force around the changes of motion, without slow drift."""

    time: Array
    force: Array
    drift: Array  # (sample, function), orthonormal
    both: Array  # drift and force, (function, sample)


def force_samples(
    force_time: Array, force: Array, basis: Basis, shift: float, half: float
) -> ForceSamples:
    """Return the force around changes of motion, at a shift [s] known to `half` [s]."""
    used = _samples_near_changes(force_time, basis, shift, half)
    time, force = force_time[used], force[used]
    if not len(time):
        return ForceSamples(
            time, force, np.zeros((0, DRIFT_FUNCTIONS)), np.zeros((DRIFT_FUNCTIONS + 1, 0))
        )
    knots = np.linspace(time[0], time[-1], DRIFT_FUNCTIONS)
    drift, _ = np.linalg.qr(
        np.stack([np.interp(time, knots, hat) for hat in np.eye(DRIFT_FUNCTIONS)], 1)
    )
    force = force - drift @ (drift.T @ force)
    return ForceSamples(time, force, drift, np.concatenate([drift.T, force[None]]))
