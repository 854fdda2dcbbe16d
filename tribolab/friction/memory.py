"""What a memory that is long beside the record leaves unknown of its mean.

Notes
-----
A spectrum that is fitted to a record knows nothing below the lowest frequency that the record
holds, and a wander that has gone only one way looks like no wander at all. So the record's means
over stretches of time are described as a level, white noise, and a wander that forgets itself
within a time tau (an Ornstein-Uhlenbeck process), and nothing but the record tells how large and
how slow that wander is: every tau from a hundredth of the record to all of it and every share of
white noise is weighed by how well it describes the record (level and size integrated out, [1]_).
The standard error is no less than a third of the distance that the level exceeds with a chance of
0.6 %: where only the record tells how long its memory is, three errors hold 99 % and more.

What lies beneath white noise tells little of itself. Over 1000 records of 400 samples each, with a
memory (AR(1)) of 1, 2, 5, 8, 15, 30 % of the record, the truth was beyond three errors in 0.2, 0,
0, 0.1, 0, 0.2 %; beneath white noise twice as strong as the wander in 0.3, 0.4, 0.4, 0.7, 1.5,
3.9 %. There a record that stays on one side of its true mean looks like white noise without memory;
an error that held it would be twice as wide on every calm record (`_CALM` 0.2: 1.8 %, and 1.9
times). Strokes that are repeated show it, one alone does not.

References
----------
.. [1] Box and Jenkins (1976), Time Series Analysis, Holden-Day; the integrals over level and
   size as for a linear model with flat priors: Gelman et al. (2013), Bayesian Data Analysis,
   ch. 14. doi:10.1201/b16018
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import special

_TIMES = np.geomspace(0.01, 0.7, 8)  # of the record
_WHITE = np.concatenate([[0.0], np.geomspace(0.01, 100.0, 9)])  # variances, of the wander's
_CALM = 0.8  # chance, before the record is seen, that there is no wander
_FEWEST = 8  # stretches
_HALVINGS = 50  # of pi/(n + 1): to the last digit
_NEGLIGIBLE = 1e-7  # chance of a model that no other figure of the answer knows of
_BEYOND = 0.006  # chance of more than three standard errors, where a memory may be long


class MemoryModels(NamedTuple):
    """What does not depend on the record: axes (time), their variances and the level on them."""

    axes: np.ndarray  # (time, axis, stretch)
    weight: np.ndarray  # (time, white, axis): one over their variance
    level: np.ndarray  # (time, axis)
    of_level: np.ndarray  # (time, white): what all axes tell of the level
    prior: np.ndarray  # (time, white), logarithm, with all that is the same for every record


def wander_axes(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Independent parts of a wander of each memory time, and their variances.

    Parameters
    ----------
    count
        Number of stretches n of the record.

    Returns
    -------
    variances, axes : numpy.ndarray
        (time, axis) and (time, axis, stretch), for a wander of variance 1: eigenvalues and
        eigenvectors of ``rho**abs(i - j)``, ``rho = exp(-1/(n tau))``.

    Notes
    -----
    In closed form [2]_: the variances are (1 - rho^2)/(1 - 2 rho cos w + rho^2) at the n roots w of
    sin((n+1) w) - 2 rho sin(n w) + rho^2 sin((n-1) w), one between each two multiples of pi/(n+1),
    and the axes are cosines and sines of w about the record's middle, in turn.

    References
    ----------
    .. [2] Grenander and Szego (1958), Toeplitz Forms and Their Applications, sec. 5.3.
    """
    rho = np.exp(-1 / (count * _TIMES))[:, None]
    number = np.arange(count)
    below = np.broadcast_to(number * np.pi / (count + 1), (_TIMES.size, count))
    width = np.pi / (count + 1)
    sign = 1.0 - 2.0 * (number % 2)  # of the polynomial below its root
    for _ in range(_HALVINGS):
        width /= 2
        w = below + width
        value = np.sin((count + 1) * w) - rho * (
            2 * np.sin(count * w) - rho * np.sin((count - 1) * w)
        )
        below = np.where(sign * value > 0, w, below)
    w = below + 0.5 * width
    variances = (1 - rho**2) / ((1 - rho) ** 2 + 4 * rho * np.sin(w / 2) ** 2)
    phase = w[:, :, None] * (number - 0.5 * (count - 1))
    phase[:, 1::2] -= 0.5 * np.pi  # sines
    axes = np.cos(phase, out=phase)
    axes /= np.sqrt(np.einsum("tas,tas->ta", axes, axes))[:, :, None]
    return variances, axes


@lru_cache(maxsize=16)
def _models(count: int) -> MemoryModels:
    own, axes = wander_axes(count)
    variance = own[:, None, :] + _WHITE[None, :, None] + 1e-9
    prior = np.full((_TIMES.size, _WHITE.size), (1 - _CALM) / (_TIMES.size * _WHITE.size))
    # no wander at all: the last share of white noise, at any time
    variance[:, -1, :] = 1.0
    prior[:, -1] = _CALM / _TIMES.size
    level, weight = axes.sum(axis=2), 1 / variance
    of_level = (weight * level[:, None, :] ** 2).sum(axis=2)
    fixed = np.log(prior) - 0.5 * (np.log(variance).sum(axis=2) + np.log(of_level))
    return MemoryModels(axes, weight, level, of_level, fixed)


def errors_with_memory(records: np.ndarray) -> np.ndarray:
    """Return the standard error of the mean of records whose memory may be long.

    Parameters
    ----------
    records
        Means over equal stretches of time, one record in each row, in any unit.

    Returns
    -------
    numpy.ndarray
        The errors such that three of each hold 99.4 % (record); 0 for fewer than 8 stretches.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> calm = rng.standard_normal(96)
    >>> slow = np.cumsum(calm)
    >>> (errors_with_memory(np.stack([calm, slow])) / [calm.std(), slow.std()]).round(1).tolist()
    [0.1, 0.8]
    """
    size, n = records.std(axis=1), records.shape[1]
    moved = size > 0
    if n < _FEWEST or not moved.any():
        return np.zeros(len(records))
    models, size = _models(n), np.where(moved, size, 1.0)
    centred = (records - records.mean(axis=1, keepdims=True)) / size[:, None]
    centred[~moved] = np.arange(n)  # any: their error is nothing
    own = models.axes @ centred.T  # (time, axis, record)
    of_level = models.of_level[:, :, None]
    place = models.weight @ (models.level[:, :, None] * own) / of_level
    squares = models.weight @ own**2 - of_level * place**2
    scale = np.sqrt(np.maximum(squares, 1e-300) / (n - 1) / of_level)
    likely = models.prior[:, :, None] - 0.5 * (n - 1) * np.log(np.maximum(squares, 1e-300))
    chance = np.exp(likely - likely.max(axis=(0, 1)))
    chance /= chance.sum(axis=(0, 1))
    told = chance > _NEGLIGIBLE
    row = np.nonzero(told)[2]
    level = Level(n - 1, row, place[told], scale[told], chance[told])
    return np.where(moved, level.exceeded_with(_BEYOND, len(records)) / 3 * size, 0.0)


class Level(NamedTuple):
    """What each model that is likely enough tells of the level of its record."""

    freedom: int
    row: np.ndarray  # number of the record
    place: np.ndarray
    scale: np.ndarray
    chance: np.ndarray

    def beyond(self, distance: np.ndarray) -> np.ndarray:
        """Return minus the logarithm of the chance that the level lies farther away (record)."""
        own = distance[self.row]
        sides = np.stack([self.place - own, -self.place - own]) / self.scale
        chance = special.stdtr(self.freedom, sides).sum(axis=0) * self.chance
        return -np.log(np.bincount(self.row, chance, len(distance)))

    def exceeded_with(self, chance: float, records: int) -> np.ndarray:
        """Return the distance that the level exceeds with a chance (record)."""
        wanted = -np.log(chance)
        grid = np.geomspace(0.3, 60.0, 12) / np.sqrt(self.freedom + 1)
        after = self._first_beyond(np.repeat(grid[None], records, axis=0), wanted)
        # first roughly, then between the two nearest
        grid = np.geomspace(grid[after - 1], grid[after], 10, axis=1)
        after = self._first_beyond(grid, wanted)
        ends = [grid[np.arange(records), at] for at in (after - 1, after)]
        below, above = map(self.beyond, ends)
        share = np.clip((wanted - below) / (above - below), 0.0, 1.0)
        first, last = map(np.log, ends)
        distance: np.ndarray = np.exp(first + share * (last - first))
        return distance

    def _first_beyond(self, grid: np.ndarray, wanted: float) -> np.ndarray:
        """Return the first place on a grid (record, place) that is beyond, the second at least."""
        rows = np.arange(len(grid))
        below, above = np.zeros(len(grid), int), np.full(len(grid), grid.shape[1] - 1)
        while (above - below).max() > 1:
            middle = (below + above + 1) // 2
            beyond = self.beyond(grid[rows, middle]) >= wanted
            above, below = np.where(beyond, middle, above), np.where(beyond, below, middle)
        return above
