"""Test whether a short plateau next to a long ramp is distinct from the ramp.

Notes
-----
A short part of a ramp, a turning point or the top of a sinusoid looks level within noise and
digits. A piece that is short compared with the adjacent ramp must therefore meet two conditions:

1. The parabola through its own readings changes by no more than `drift` of the speed, beyond its
   error.
2. A level with straight flanks describes the piece and as much again on the sides of the ramp
   better than one smooth motion (a quartic) or one turn (two lines that meet), by Schwarz's
   criterion [1]_.

If positions were recorded, the integrals of these motions are fitted to them: differences of
positions contain more noise.

References
----------
.. [1] Schwarz (1978), Ann. Stat. 6, 461-464. doi:10.1214/aos/1176344136
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from tribolab.friction.segments import limits
from tribolab.friction.segments.noise import running_median

_FITTED_READINGS = 512  # most readings of a fit; more are averaged in groups
# smallest outlier as a share of the range of velocities (False) or positions (True)
_OUTLIER_SHARES = {False: 0.2, True: 0.02}
_SIDE_LENGTHS = (0.5, 1.0)  # trial lengths of the neighbourhood, relative to the piece
_END_SHIFTS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # trial shifts of a piece's end, relative to its length
_TURN_PLACES = np.linspace(-0.8, 0.8, 17)  # trial positions of a turn, relative to half the window
_TURN_REFINEMENTS = 4  # number of refinements of the position of the turn


class Readings(NamedTuple):
    """Readings of an interval: times [s], and velocities [m/s] or positions [m]."""

    time: np.ndarray
    values: np.ndarray
    is_position: bool

    def within(self, begin: float, end: float) -> Readings:
        """Return the readings between two times, averaged if there are many."""
        first, last = np.searchsorted(self.time, [begin, end])
        time, values = self.time[first:last], self.values[first:last]
        median = running_median(values)
        if values.size:
            off = np.abs(values - median)
            # a turn is not a spike, however low the noise
            least = _OUTLIER_SHARES[self.is_position] * float(np.ptp(median))
            values = np.where(
                off > max(limits.MIN_OUTLIER.value * float(np.mean(off)), least), median, values
            )
        size = -(-time.size // _FITTED_READINGS)
        if size > 1:
            count = time.size // size
            time, values = (
                a[: count * size].reshape(count, size).mean(axis=1) for a in (time, values)
            )
        return self._replace(time=time, values=values)


class Fit(NamedTuple):
    """Coefficients, covariance, residual variance, effective readings, number of parameters."""

    coefficients: np.ndarray
    covariance: np.ndarray
    variance: float
    samples: float
    parameters: int


def _fit(basis: np.ndarray, values: np.ndarray) -> Fit:
    """Fit a basis by least squares; correlated residuals reduce the effective readings."""
    terms = np.linalg.lstsq(basis, values, rcond=None)[0]
    rest = values - basis @ terms
    n, k = basis.shape
    tiny = 1e-14 * float(np.mean(values**2)) + 1e-300
    variance = max(float(rest @ rest) / max(n - k, 1), tiny)
    alike = float(rest[1:] @ rest[:-1] / (rest @ rest)) if rest @ rest > 0 else 0.0
    alike = min(max(alike, 0.0), 0.9)
    samples = n * (1 - alike) / (1 + alike)
    covariance = np.linalg.pinv(basis.T @ basis) * variance * n / samples
    return Fit(terms, covariance, variance, samples, k)


def _columns(readings: Readings, place: np.ndarray, motion: list[np.ndarray]) -> np.ndarray:
    """Return basis functions of a motion as columns; integrated if positions were recorded."""
    columns = np.stack(motion, axis=1)
    if not readings.is_position:
        return columns
    steps = np.diff(place)[:, None] * (columns[1:] + columns[:-1]) / 2
    way = np.concatenate([np.zeros((1, columns.shape[1])), np.cumsum(steps, axis=0)])
    return np.column_stack([way, np.ones(place.size)])


def change_along(readings: Readings, begin: float, end: float) -> tuple[float, float]:
    """Return the change of speed along a piece, by a parabola, and its standard error [m/s].

    Both are NaN for too few readings.

    Parameters
    ----------
    readings
        Readings of the record.
    begin, end
        Start and end of the piece [s].

    Examples
    --------
    >>> time = np.linspace(0, 1, 101)
    >>> change, error = change_along(Readings(time, 0.2 * time**2 / 2, True), 0.0, 2.0)
    >>> round(change, 3), error < 1e-6
    (0.2, True)
    """
    own = readings.within(begin, end)
    degree = 3 if own.is_position else 2
    if own.time.size < degree + 3 or not np.ptp(own.time) > 0:
        return np.nan, np.nan
    half = float(np.ptp(own.time)) / 2
    place = (own.time - own.time[0]) / half - 1
    shift = float(own.values.mean())
    line = _fit(legendre.legvander(place, degree), own.values - shift)
    ends = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    unit = np.eye(degree + 1)
    if own.is_position:
        reading = np.stack([legendre.legval(ends, legendre.legder(u)) for u in unit], 1) / half
    else:
        reading = legendre.legvander(ends, degree)
    speeds = reading @ line.coefficients
    high, low = int(speeds.argmax()), int(speeds.argmin())
    apart = reading[high] - reading[low]
    return float(speeds[high] - speeds[low]), float(np.sqrt(apart @ line.covariance @ apart))


def changes_significantly(readings: Readings, begin: float, end: float, most: float) -> bool:
    """Return whether the speed clearly changes by more than `most` [m/s] along a piece."""
    change, error = change_along(readings, begin, end)
    return bool(change > most + limits.MIN_ERRORS_OF_CHANGE.value * error)


def is_proven(
    readings: Readings, begin: float, end: float, most: float, sides: tuple[bool, bool]
) -> bool:
    """Return whether a piece next to a long ramp has constant speed.

    Parameters
    ----------
    readings
        Readings of the record.
    begin, end
        The piece [s].
    most
        Change of speed that a plateau may show [m/s].
    sides
        Whether a ramp is before and after the piece.
    """
    change, error = change_along(readings, begin, end)
    if not change + limits.MIN_ERRORS_WITHIN_DRIFT.value * error <= most:
        return False
    return any(_is_level(readings, begin, end, sides, side) for side in _SIDE_LENGTHS)


def _is_level(
    readings: Readings, begin: float, end: float, sides: tuple[bool, bool], side: float
) -> bool:
    """Return whether a plateau with flanks fits better than a smooth motion or a reversal."""
    size = side * (end - begin)
    window = readings.within(begin - sides[0] * size, end + sides[1] * size)
    time, values = window.time, window.values - window.values.mean()
    if time.size < 12:
        return False
    middle, half = (time[0] + time[-1]) / 2, (time[-1] - time[0]) / 2
    place = (time - middle) / half
    corners = (begin - middle) / half, (end - middle) / half

    def fitted(motion: list[np.ndarray], free: int) -> tuple[Fit, int]:
        return _fit(_columns(window, place, motion), values), free

    levels = [fitted(*case) for case in _levels(place, corners, sides)]
    others = [fitted(*case) for case in _motions(place)]
    turns, width = _TURN_PLACES, _TURN_PLACES[1] - _TURN_PLACES[0]
    for _ in range(_TURN_REFINEMENTS):
        misfits = [fitted(_turn(place, at), 1) for at in turns]
        others += misfits
        best = int(np.argmin([fit.variance for fit, _ in misfits]))
        turns, width = turns[best] + width * np.linspace(-1, 1, 11), width / 5
    # all fits are compared at the number of effective readings of the best one
    count = min(levels + others, key=lambda misfit: misfit[0].variance)[0].samples

    def schwarz(fits: list[tuple[Fit, int]]) -> float:
        price = np.log(time.size)
        return min(
            count * float(np.log(fit.variance)) + (fit.parameters + free) * price
            for fit, free in fits
        )

    return schwarz(levels) + limits.MIN_GAIN_OF_LEVEL.value < schwarz(others)


def _levels(
    place: np.ndarray, corners: tuple[float, float], sides: tuple[bool, bool]
) -> list[tuple[list[np.ndarray], int]]:
    """Return basis functions of a plateau with straight flanks, for several corner positions."""
    size = corners[1] - corners[0]
    levels = []
    for before in _END_SHIFTS if sides[0] else (None,):
        for after in _END_SHIFTS if sides[1] else (None,):
            motion = [np.ones(place.size), place]
            for shift, corner, way in ((before, corners[0], -1), (after, corners[1], 1)):
                if shift is not None:
                    beyond = way * (place - corner) - shift * size
                    motion += [np.maximum(beyond, 0.0), (beyond > 0).astype(float)]
            levels.append((motion, sum(sides)))
    return levels


def _turn(place: np.ndarray, at: float) -> list[np.ndarray]:
    """Return basis functions of two straight lines joined at a reversal."""
    return [np.ones(place.size), place, np.abs(place - at)]


def _motions(place: np.ndarray) -> list[tuple[list[np.ndarray], int]]:
    """Return basis functions of smooth motions: polynomials of degree 1 to 4."""
    return [(list(legendre.legvander(place, degree).T), 0) for degree in (1, 2, 3, 4)]
