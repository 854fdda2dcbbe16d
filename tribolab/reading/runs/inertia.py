"""Inertial force of the moving mass between contact and force sensor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import Cure, ReadError
from tribolab.units.stamping import stamp

_MOTION = ("sliding_velocity", "position")
_WIDEST = 200  # most samples on either side of a window
_MAD = 0.6745  # median absolute deviation of a normal distribution with standard deviation 1


class Acceleration(NamedTuple):
    """Acceleration [m/s2] (time), its standard error, and its smoothing.

    `order` is the order of the derivative, `half_window` the number of samples on either side.
    """

    value: np.ndarray
    error: float
    order: int
    half_window: int

    def gain(self, period: float) -> float:
        """Return the factor by which smoothing reduces a sine with a period [samples]."""
        turned = 2 * np.pi / period
        place = np.arange(-self.half_window, self.half_window + 1.0)
        weights = _weights(self.order, self.half_window)
        wave = np.sin(turned * place) if self.order == 1 else -np.cos(turned * place)
        return float(weights @ wave) / turned**self.order


def acceleration(
    signals: Mapping[str, np.ndarray], time: np.ndarray, accuracy: float, widest: int = _WIDEST
) -> Acceleration | None:
    """Return the acceleration of a run, smoothed only as far as needed for an accuracy.

    Parameters
    ----------
    signals
        Signals with ``position`` [m] or ``sliding_velocity`` [m/s] (time).
    time
        Time [s] (time).
    accuracy
        Wanted standard error [m/s2].
    widest
        Most samples on either side of a window.

    Returns
    -------
    Acceleration or None
        Acceleration from parabolas (Savitzky and Golay [1]_), fitted to windows that are as narrow
        as the noise allows. None without a signal of at least 5 samples.

    References
    ----------
    .. [1] Savitzky and Golay (1964), Anal. Chem. 36, 1627-1639. doi:10.1021/ac60214a047

    Examples
    --------
    >>> time = np.arange(0, 1, 0.01)
    >>> acceleration({"position": 0.5 * 3.0 * time**2}, time, 1e-6).value[50].round(6).item()
    3.0
    """
    usable = [
        (signals[name], order)
        for order, name in enumerate(_MOTION, start=1)
        if name in signals and time.size >= 5 and np.isfinite(signals[name]).all()
    ]
    if not usable:
        return None
    values, order = usable[0]
    step = float(median(np.diff(time)))
    noise = _noise(values)
    # variance of slope and second derivative of a parabola through 2 k + 1 points
    half = np.arange(2, max(min(widest, (time.size - 1) // 2), 2) + 1)
    points = 2.0 * half + 1
    if order == 1:
        errors = noise * np.sqrt(12 / (points * (points**2 - 1))) / step
    else:
        spread = points * (points**2 - 1) * (points**2 - 4)
        errors = noise * np.sqrt(720 / spread) / step**2
    enough = errors <= accuracy
    k = int(half[np.argmax(enough)] if enough.any() else half[-1])
    return Acceleration(_derivative(time, values, order, k), float(errors[half == k][0]), order, k)


def _noise(values: np.ndarray) -> float:
    """Return the noise of single samples, from third differences."""
    rough = np.abs(np.diff(values, 3))
    return float(median(rough) / _MAD / np.sqrt(20))


def _derivative(time: np.ndarray, values: np.ndarray, order: int, half: int) -> np.ndarray:
    """Return the first or second derivative by windowed parabolas; constant near the ends."""
    inner = np.correlate(values, _weights(order, half), mode="valid")
    spacing = (time[2 * half :] - time[: -2 * half]) / (2 * half)
    inner = inner / spacing**order
    return np.concatenate([np.repeat(inner[0], half), inner, np.repeat(inner[-1], half)])


def _weights(order: int, half: int) -> np.ndarray:
    """Return the weights of a window's samples that give the derivative of a fitted parabola."""
    place = np.arange(-half, half + 1.0)
    if order == 1:
        return np.asarray(place / np.sum(place**2))
    even = place**2 - np.mean(place**2)
    return np.asarray(2 * even / np.sum(even**2))


def take_inertia(run: xr.Dataset, mass: float, where: str, **stated: str | float) -> xr.Dataset:
    """Subtract the inertial force of a mass from the friction force.

    Parameters
    ----------
    run
        Run with ``friction_force`` and ``position`` or ``sliding_velocity`` (time).
    mass
        Mass between contact and force sensor [kg].
    where
        The run, for messages.
    **stated
        Attributes on the source of the mass.

    Returns
    -------
    xarray.Dataset
        The run with ``inertial_force`` [N] (time), which is subtracted from ``friction_force``.
        Attributes ``moving_mass_kg``, ``inertial_force_largest_N`` (99.9 % quantile) and
        ``inertial_force_noise_N`` (its standard error, due to noise of the motion
        signal).

    Raises
    ------
    ReadError
        If friction force is missing, or position and velocity are incomplete.

    Notes
    -----
    The sensor reads F + m a, both positive along the motion. If strokes show the opposite sign of
    friction, the sign of the inertial force is also reversed. The acceleration is smoothed until
    its noise does not exceed that of the force.
    """
    time = run["time"].values
    signals = {name: run[name].values for name in _MOTION if name in run}
    known = None
    if "friction_force" in run:
        force = run["friction_force"].values
        known = acceleration(signals, time, _noise(force[np.isfinite(force)]) / mass)
    if known is None:
        lost = "position or velocity in all rows" if "friction_force" in run else "friction force"
        raise ReadError(
            f"a moving mass of {mass:g} kg is stated, but the run has no {lost}",
            where=where,
            cure=Cure(*["leave moving_mass out"] * 3),
        )
    inertia = _force_sign(signals, force) * mass * known.value
    attrs = dict(run["friction_force"].attrs)
    result = run.assign(
        friction_force=("time", force - inertia, attrs), inertial_force=("time", inertia)
    )
    found = {
        "moving_mass_kg": mass,
        "inertial_force_largest_N": float(np.quantile(np.abs(inertia), 0.999)),
        "inertial_force_noise_N": mass * known.error,
    }
    return stamp(result, **(run.attrs | found | stated))


def _force_sign(signals: Mapping[str, np.ndarray], force: np.ndarray) -> float:
    """Return +1 if the force is positive along the motion, else -1."""
    velocity = signals.get("sliding_velocity")
    velocity = np.gradient(signals["position"]) if velocity is None else velocity
    fast = np.abs(velocity) > 0.3 * np.quantile(np.abs(velocity), 0.95)
    ways = [force[fast & (velocity * way > 0)] for way in (1, -1)]
    if min(part.size for part in ways) < 10:
        return 1.0
    return 1.0 if np.nanmean(ways[0]) >= np.nanmean(ways[1]) else -1.0
