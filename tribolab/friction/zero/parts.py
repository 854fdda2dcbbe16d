"""Inputs and result of the determination of the zero of friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from tribolab.friction.zero.rests import Zeros


@dataclass(frozen=True)
class StrokeMeans:
    """Means of the strokes from which the zero is determined: one value for each segment.

    Parameters
    ----------
    mean, error
        Mean force and its standard error, in the unit u of the signal.
    load
        Mean normal force [N], or one for all if unknown.
    sign
        Direction.
    speed, time
        Sliding speed [m/s] and middle [s].
    pair
        Number of the pair, -1 for none.
    number
        Displayed number of each segment.
    unit
        The unit u, as text that follows a number.
    """

    mean: np.ndarray
    error: np.ndarray
    load: np.ndarray
    sign: np.ndarray
    speed: np.ndarray
    time: np.ndarray
    pair: np.ndarray
    number: np.ndarray
    unit: str = " N"

    @property
    def size(self) -> int:
        """Number of segments."""
        return self.mean.size


@dataclass(frozen=True)
class KnownOfZero:
    """Information on the zero from other sources than the strokes.

    Parameters
    ----------
    rests
        Zeros from rests without load, of a signal that has its sign.
    stated
        Stated standard uncertainty of a signal whose zero was set [u], or NaN.
    others
        Zeros of other runs on the same instrument [u].
    tolerance
        Relative difference of speed up to which the user states that friction is equal.
    read
        Standard error of a zero that was read at one place of the file and subtracted [u].
    read_from
        Place of that zero in the file.
    """

    rests: Zeros | None = None
    stated: float = float("nan")
    others: tuple[float, ...] = ()
    tolerance: float = 0.25
    read: float = float("nan")
    read_from: str = ""


class Doubt(TypedDict):
    """Doubt about the zero of some segments: check that reports it, and how to resolve it."""

    check: str
    status: str
    message: str
    cure: str
    segments: list[int]
    noted: bool


@dataclass(frozen=True)
class ZeroReference:
    """Zero of each segment and its source.

    Parameters
    ----------
    value
        Zero of each segment at its middle [u] (segment).
    slope
        Its drift [u/s] (segment).
    error
        Function that returns the errors of the forces minus their zero, from the errors of the
        forces themselves (segment).
    zero_from
        Source of the zero, in words (segment).
    half_loop
        Half loop of each stroke's pair, without the drift of the zero [u]; NaN without a pair.
    method
        Source for the whole run: "half loop", "zero load", "stated", "other runs", "none: ...".
    doubts
        Doubts about the zero.
    stated
        Stated standard uncertainty of the zero, included in every error [u]; NaN for none.
    """

    value: np.ndarray
    slope: np.ndarray
    error: Callable[[np.ndarray], np.ndarray]
    zero_from: np.ndarray
    half_loop: np.ndarray
    method: str
    doubts: tuple[Doubt, ...] = field(default=())
    stated: float = float("nan")


def doubt(text: str, cure: str, which: np.ndarray, status: str = "suspect") -> Doubt:
    """Return a doubt about the zero of some segments, with the measurement that resolves it."""
    return {
        "check": "zero_reference",
        "status": status,
        "message": text,
        "cure": cure,
        "segments": [int(i) for i in which],
        "noted": status == "pass",
    }
