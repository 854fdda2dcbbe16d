"""A trial: one run as its lab hands it over, and the truth that nobody tells the analysis."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from tricky.contact import Slid
from tricky.motion import Motion


@dataclass(frozen=True)
class Truth:
    """Plateaus (start, stop [s], signed speed [m/s]) and the kinetic coefficient over time.

    `velocity` [m/s] over time, of motions without a plateau.
    """

    start: np.ndarray
    stop: np.ndarray
    speed: np.ndarray
    time: np.ndarray
    mu: np.ndarray
    velocity: np.ndarray | None = None

    def mean(self, start: float, stop: float) -> float:
        """Time mean of the kinetic coefficient."""
        first, last = np.searchsorted(self.time, [start, stop])
        return float(self.mu[first : max(last, first + 1)].mean())

    def mean_speed(self, start: float, stop: float) -> float:
        """Mean speed [m/s] of motion that goes one way all the time, NaN of other motion."""
        if self.velocity is None:
            return float("nan")
        own = self.velocity[slice(*np.searchsorted(self.time, [start, stop]))]
        one_way = own.size > 0 and ((own > 0).all() or (own < 0).all())
        return float(abs(own.mean())) if one_way else float("nan")


def truth_of(motion: Motion, slid: Slid) -> Truth:
    """Return the truth of a motion on its own clock."""
    return Truth(motion.start, motion.stop, motion.speed, motion.time, slid.level)


@dataclass(frozen=True)
class Trial:
    """One run.

    data
        A Dataset, or texts by file name; the first file is the run's, the others lie beside it.
    dialects
        TOML by name of the dialect; the first is that of the run. Empty: drafted from the file.
    settings
        What the user states: keywords of `friction_coefficient` by name.
    checks
        What the user states for the checks (keywords of `check`).
    pair_truth
        The truth of a half loop is the mean of both ways: no zero tells them apart.
    unsure_only
        Nothing in file or dialect can tell the answer: only suspect or fail is right.
    drop
        Segments that the user takes out by hand, by number.
    lost_is_wrong
        Segments that are missing without a word count as wrong.
    clock_shift
        True shift of a companion's clock [s].
    """

    data: xr.Dataset | Mapping[str, str]
    truth: Truth
    dialects: Mapping[str, str] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    checks: Mapping[str, Any] = field(default_factory=dict)
    pair_truth: bool = False
    unsure_only: bool = False
    drop: tuple[int, ...] = ()
    lost_is_wrong: bool = False
    clock_shift: float | None = None
    note: str = ""


Maker = Callable[[np.random.Generator], Trial]


@dataclass(frozen=True)
class Kind:
    """A kind of run: what it is called, which demand it tests, and who makes it."""

    name: str
    item: str
    make: Maker

    def trial(self, seed: int) -> Trial:
        """Make one; kind and seed say all."""
        return self.make(np.random.default_rng([zlib.crc32(self.name.encode()), seed]))


TRICKY: dict[str, Kind] = {}
SOUND: dict[str, Kind] = {}


def tricky(item: str) -> Callable[[Maker], Maker]:
    """Register a kind of tricky run under the function's name."""

    def register(make: Maker) -> Maker:
        TRICKY[make.__name__] = Kind(make.__name__, item, make)
        return make

    return register


def sound(make: Maker) -> Maker:
    """Register a kind of run that has nothing tricky about it."""
    SOUND[make.__name__] = Kind(make.__name__, "sound", make)
    return make
