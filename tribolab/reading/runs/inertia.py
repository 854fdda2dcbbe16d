"""The force that a moving mass between contact and sensor takes to be accelerated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import Cure, ReadError
from tribolab.units.stamping import stamp

_MOTION = ("sliding_velocity", "position")
_WIDEST = 200  # samples on either side of a window
_MAD = 0.6745  # of a normal distribution with a standard deviation of 1


class Acceleration(NamedTuple):
    """Acceleration [m/s2] (time), its standard error, and how it was smoothed.

    `order` is that of the derivative of the signal, `half_window` the samples on either side.
    """

    value: np.ndarray
    error: float
    order: int
    half_window: int

    def gain(self, period: float) -> float:
        """Return what smoothing leaves of a sine with a period [samples]."""
        turned = 2 * np.pi / period
        place = np.arange(-self.half_window, self.half_window + 1.0)
        weights = _weights(self.order, self.half_window)
        wave = np.sin(turned * place) if self.order == 1 else -np.cos(turned * place)
        return float(weights @ wave) / turned**self.order


def acceleration(
    signals: Mapping[str, np.ndarray],
    time: np.ndarray,
    accuracy: float,
    widest: int = _WIDEST,
) -> Acceleration | None:
    """Return the acceleration of a run, smoothed no further than an accuracy wants.

    Parameters
    ----------
    signals
        With ``position`` [m] or ``sliding_velocity`` [m/s] (time).
    time
        [s] (time).
    accuracy
        Wanted standard error [m/s2].
    widest
        Samples on either side of a window, at most.

    Returns
    -------
    Acceleration or None
        By parabolas fitted to windows (Savitzky and Golay [1]_), as narrow as the noise of the
        signal allows; None where neither signal is there or has 5 samples.

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
    # variance of the slope, and of the second derivative, of a parabola through 2 k + 1 points
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
    """Noise of single samples: third differences take out what is smooth."""
    rough = np.abs(np.diff(values, 3))
    return float(median(rough) / _MAD / np.sqrt(20))


def _derivative(time: np.ndarray, values: np.ndarray, order: int, half: int) -> np.ndarray:
    """First or second derivative by parabolas over windows; near the ends that of the next one."""
    inner = np.correlate(values, _weights(order, half), mode="valid")
    spacing = (time[2 * half :] - time[: -2 * half]) / (2 * half)
    inner = inner / spacing**order
    return np.concatenate([np.repeat(inner[0], half), inner, np.repeat(inner[-1], half)])


def _weights(order: int, half: int) -> np.ndarray:
    """Weights of the samples of a window in the derivative of its parabola, per spacing."""
    place = np.arange(-half, half + 1.0)
    if order == 1:
        return np.asarray(place / np.sum(place**2))
    even = place**2 - np.mean(place**2)
    return np.asarray(2 * even / np.sum(even**2))


def take_inertia(run: xr.Dataset, mass: float, where: str, **said: str | float) -> xr.Dataset:
    """Take the force that accelerates a mass out of the friction force.

    Parameters
    ----------
    run
        With ``friction_force`` and ``position`` or ``sliding_velocity`` (time).
    mass
        Between contact and sensor [kg].
    where
        The run, for messages.
    **said
        Attributes that say where the mass is known from.

    Returns
    -------
    xarray.Dataset
        The run with ``inertial_force`` [N] (time), and without it in ``friction_force``. Attributes
        ``moving_mass_kg``, ``inertial_force_largest_N`` (that of 99.9 % of the samples is less) and
        ``inertial_force_noise_N``, what noise of the motion is in it.

    Raises
    ------
    ReadError
        If there is no friction force, or neither position nor velocity in all rows.

    Notes
    -----
    The sensor shows F + m a, both counted along the motion. Where strokes show that it counts
    friction against it, the inertia is counted so as well. The acceleration is smoothed until its
    noise adds no more than the force has itself.
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
    inertia = _orientation(signals, force) * mass * known.value
    attrs = dict(run["friction_force"].attrs)
    result = run.assign(
        friction_force=("time", force - inertia, attrs), inertial_force=("time", inertia)
    )
    told = {
        "moving_mass_kg": mass,
        "inertial_force_largest_N": float(np.quantile(np.abs(inertia), 0.999)),
        "inertial_force_noise_N": mass * known.error,
    }
    return stamp(result, **(run.attrs | told | said))


def _orientation(signals: Mapping[str, np.ndarray], force: np.ndarray) -> float:
    """Return +1 where the force is counted along the motion, -1 where against it."""
    velocity = signals.get("sliding_velocity")
    velocity = np.gradient(signals["position"]) if velocity is None else velocity
    fast = np.abs(velocity) > 0.3 * np.quantile(np.abs(velocity), 0.95)
    ways = [force[fast & (velocity * way > 0)] for way in (1, -1)]
    if min(part.size for part in ways) < 10:
        return 1.0
    return 1.0 if np.nanmean(ways[0]) >= np.nanmean(ways[1]) else -1.0
