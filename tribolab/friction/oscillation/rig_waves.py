"""Waves that repeat with each turn or stroke of a rig: run-out, not stick-slip.

Notes
-----
Run-out of a disc, or a track that varies along its circumference, changes friction at whole
multiples of the rotation frequency. These frequencies are known, like those of the mains: waves are
fitted to the angle of the rig. A speed that is wrong by some per cent would lose phase with the
disc over many turns, so the waves are fitted to a few turns at a time. They are attributed to the
rig if they exceed their surroundings in the spectrum and keep their phase from one piece to the
next; stick-slip whose period is one turn by chance does not. If a record is sampled too slowly,
waves appear at an alias frequency (8 Hz at 2 Hz with 5 samples per second), but are still found
from the rig's angle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special

from tribolab.arrays.chunks import pieces
from tribolab.friction.oscillation import limits
from tribolab.friction.run_out import turned

_TURNS_PER_FIT = 8.0  # turns of the rig in one fit
_MAX_ORDER = 8
_BLOCKS_PER_TURN = 32  # blocks per turn to which waves are fitted
# distances from a line, in spectral widths, between which its surroundings lie
_WIDTHS_TO_SURROUNDINGS = (1.0, 1.5, 2.0)
_FAST_PIECE_SAMPLES = 64  # samples in one fit of waves too fast for the sampling rate
_MAX_FAST_ORDER = 2
REPEATS = "repeats"  # word for such waves in the text of ``instrument``
_TIMES = {1: "once", 2: "twice"}


class RigWave(NamedTuple):
    """Wave that repeats with each turn of a rig: values (time), swing, and periods per turn.

    `undersampled` waves are faster than half the rate of the record.
    """

    signal: np.ndarray
    swing: float
    orders: tuple[int, ...]
    undersampled: bool = False

    def words(self, what: str) -> str:
        """Return how often a wave repeats per period of the rig as text; `what` is, e.g., "turn".

        Examples
        --------
        >>> RigWave(np.zeros(0), 0.1, (1, 2)).words("turn")
        'run-out: repeats once and twice a turn'
        """
        often = [_TIMES.get(order, f"{order} times") for order in self.orders]
        listed = ", ".join(often[:-1]) + " and " + often[-1] if often[1:] else often[0]
        kind = "run-out" if what == "turn" else "the strokes"
        return f"{kind}: {REPEATS} {listed} a {what}"


class RigMotion(NamedTuple):
    """Angular frequency [rad/s] of a rotating or reciprocating rig; name of its period."""

    rate: np.ndarray | float
    what: str

    def angle(self, time: np.ndarray, part: slice) -> np.ndarray:
        """Return the rig's angle [rad] at given times [s] in an index range of samples."""
        if isinstance(self.rate, float):
            return self.rate * (time - time[:1])
        return turned(time, self.rate[part])


def motion_of(run: xr.Dataset) -> RigMotion | None:
    """Return the rotation of a rig, or its strokes at a stated frequency; None if unknown.

    Parameters
    ----------
    run
        With ``rotation_speed``, or with a rotation speed or stroke frequency stated in its file.
    """
    if "rotation_speed" in run:
        return RigMotion(run["rotation_speed"].values, "turn")
    if stated := run.attrs.get("rotation_speed_rad_s"):
        return RigMotion(float(stated), "turn")
    if strokes := run.attrs.get("stroke_frequency_Hz"):
        return RigMotion(2 * np.pi * float(strokes), "cycle")
    return None


def rig_wave(values: np.ndarray, angle: np.ndarray) -> RigWave | None:
    """Find waves that repeat with each turn of a rig; None if not significant.

    Parameters
    ----------
    values, angle
        The signal in any unit, and the angle of the rig [rad] (time).

    Examples
    --------
    >>> angle = np.arange(2000) * 0.05
    >>> noise = np.random.default_rng(1).standard_normal(2000)
    >>> wave = rig_wave(np.sin(angle) + 0.1 * noise, angle)
    >>> wave.orders, round(wave.swing, 1)
    ((1,), 2.0)
    >>> rig_wave(np.sin(1.6 * angle) + 0.1 * noise, angle) is None
    True
    """
    n = values.size
    if n < 16 or not np.isfinite(angle[-1]) or not np.isfinite(values.sum()):
        return None
    turns = abs(float(angle[-1] - angle[0])) / (2 * np.pi)
    if turns < limits.MIN_TURNS.value:
        return None
    slow = int(limits.MAX_PERIODS_PER_SAMPLE.value * n / turns)
    orders = np.arange(1, min(_MAX_ORDER, slow) + 1)
    size = max(1, int(n / turns / _BLOCKS_PER_TURN))
    found = None
    if orders.size:
        found = _find_repeated(
            values,
            angle,
            orders,
            max(1, round(turns / _TURNS_PER_FIT)),
            size,
            limits.MAX_PHASE_SHIFT_PER_TURN.value,
        )
    if found is not None:
        return found
    fast = np.arange(slow + 1, _MAX_FAST_ORDER + 1)
    # apparent (aliased) frequency in cycles per sample
    seen = np.abs((fast * turns / n + 0.5) % 1 - 0.5)
    fast = fast[
        (seen > limits.MIN_DISTANCE_OF_ALIAS.value)
        & (seen < 0.5 - limits.MIN_DISTANCE_OF_ALIAS.value)
    ]
    count = n // _FAST_PIECE_SAMPLES
    if not fast.size or not count:
        return None
    late = limits.MAX_PHASE_SHIFT_OF_ALIAS.value * count / turns
    wave = _find_repeated(values, angle, fast, count, 1, late)
    return None if wave is None else wave._replace(undersampled=True)


def _find_repeated(
    values: np.ndarray, angle: np.ndarray, orders: np.ndarray, count: int, size: int, late: float
) -> RigWave | None:
    """Return the waves of given orders, fitted to `count` pieces in blocks of `size` samples."""
    n, turns = values.size, abs(float(angle[-1] - angle[0])) / (2 * np.pi)
    turn = np.linspace(angle[0], angle[-1], count + 1)
    edges = np.searchsorted(np.sign(turn[-1] - turn[0]) * angle, np.sign(turn[-1] - turn[0]) * turn)
    edges[-1] = n
    if np.diff(edges).min() < 3 * size * (2 * orders.size + 2):
        return None
    fits = [_fit(values[a:b], angle[a:b], size, orders, turns / count) for a, b in _ranges(edges)]
    believed, real = _significant_orders(orders, fits, turns / count, late)
    if not believed.size:
        return None
    signal = np.zeros(n)
    for (a, b), fit in zip(_ranges(edges), fits, strict=True):
        for first, last in pieces(a, b):
            turning = np.exp(1j * np.outer(orders[believed], angle[first:last]))
            signal[first:last] = (fit.size[believed] @ turning).real
    low, high = np.quantile(signal[:: max(1, n // 100_000)], [0.005, 0.995])
    return RigWave(signal, real * float(high - low), tuple(int(orders[k]) for k in believed))


class _Fit(NamedTuple):
    """Complex amplitude of each order in a piece, and mean power around it (order)."""

    size: np.ndarray
    around: np.ndarray
    freedom: np.ndarray


def _ranges(edges: np.ndarray) -> list[tuple[int, int]]:
    return list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))


def _fit(
    values: np.ndarray, angle: np.ndarray, size: int, orders: np.ndarray, turns: float
) -> _Fit:
    """Fit a line and waves to a piece; return their amplitudes, and the power around them."""
    count = values.size // size
    y = values[: count * size].reshape(count, size).mean(axis=1)
    at = angle[: count * size].reshape(count, size).mean(axis=1)
    columns = [f(k * at) for k in orders for f in (np.cos, np.sin)]
    design = np.stack([np.ones(count), np.linspace(-1, 1, count), *columns], axis=1)
    coefficients, *_ = np.linalg.lstsq(design, y, rcond=None)
    rest = y - design @ coefficients
    amplitude = coefficients[2::2] - 1j * coefficients[3::2]
    around, freedom = np.zeros(orders.size), np.zeros(orders.size)
    for k, order in enumerate(orders):
        near = order + np.array(
            [sign * off / turns for off in _WIDTHS_TO_SURROUNDINGS for sign in (-1, 1)]
        )
        near = near[near > 1 / turns]
        power = abs(2 / count * np.exp(-1j * np.outer(near, at)) @ rest) ** 2
        around[k], freedom[k] = power.mean(), 2 * near.size
    return _Fit(amplitude, around, freedom)


def _significant_orders(
    orders: np.ndarray, fits: list[_Fit], turns: float, off: float
) -> tuple[np.ndarray, float]:
    """Return significant orders with a stable phase, and their share of amplitude above noise."""
    size = np.array([fit.size for fit in fits])
    power, around = (abs(size) ** 2).mean(axis=0), np.mean([fit.around for fit in fits], axis=0)
    ratio = power / np.maximum(around, 1e-300)
    chance = special.fdtrc(2 * len(fits), len(fits) * fits[0].freedom, ratio)
    clear = (chance < limits.ORDER_BY_CHANCE.value) & (
        ratio > limits.MIN_ORDER_OVER_SURROUNDINGS.value
    )
    if len(fits) > 2:
        step = (size[1:] * size[:-1].conj()).sum(axis=0)
        whole = np.sqrt((abs(size[1:]) ** 2).sum(axis=0) * (abs(size[:-1]) ** 2).sum(axis=0))
        late = 2 * np.pi * off * turns * orders
        clear &= (abs(step) > limits.MIN_COHERENCE_OF_TURNS.value * whole) & (
            abs(np.angle(step)) < late
        )
    if not clear[orders <= limits.MAX_SOLE_ORDER.value].any():
        return np.zeros(0, int), 0.0
    noise = around[clear].sum() / power[clear].sum()
    return np.flatnonzero(clear), float(np.sqrt(max(0.0, 1 - noise)))
