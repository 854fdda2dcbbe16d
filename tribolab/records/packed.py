"""Compact encoding of signals and long texts for the page."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass

import numpy as np

from tribolab.arrays.chunks import pieces
from tribolab.core.untyped import Json

_TOP = 65534  # resolution of a value as a share of its range; 65535 is NaN
_WITHIN = 0.25  # accuracy of a time as a share of the distance to the next sample
_MAX_KNOTS = 1000
_FINER = 16  # ticks in the shortest step of an irregular clock
_MOST_TICKS = 2**32 - 1  # ticks in a record: their number must fit into 32 bits


def deflated(raw: bytes) -> str:
    """Return bytes compressed (zlib) as text (base64), safe inside a script element.

    Examples
    --------
    >>> import zlib
    >>> zlib.decompress(base64.b64decode(deflated(b"</script>" * 1000))) == b"</script>" * 1000
    True
    """
    return base64.b64encode(zlib.compress(raw, 6)).decode()


@dataclass(frozen=True)
class Clock:
    """Sampling times of a record as small numbers.

    Parameters
    ----------
    ticks
        Increasing whole number of every sample (time); None if they are the samples' indices.
    knots
        Some positions, including the first and the last.
    at_s
        Their times [s] since the first sample; linear in between.
    """

    ticks: np.ndarray | None
    knots: list[int]
    at_s: list[float]

    def places(self, chosen: np.ndarray) -> np.ndarray:
        """Return the positions on this clock of the samples with the given indices."""
        return chosen if self.ticks is None else self.ticks[chosen]


def clock_of(time: np.ndarray) -> Clock:
    """Return a clock that keeps every time to a quarter of the distance to the next sample.

    Parameters
    ----------
    time
        Times of all samples [s] (time), increasing.

    Returns
    -------
    Clock
        Its positions are the samples' indices, with knots where the sampling rate changes. A clock
        with too many knots counts ticks instead, sixteen in its shortest steps.

    Examples
    --------
    >>> clock_of(np.r_[np.arange(100) * 1e-3, 0.1 + np.arange(11)]).knots
    [0, 100, 110]
    >>> clock_of(np.array([0.0, 0.0, 1.0, 5.0])).ticks.tolist()
    [0, 0, 16, 80]
    """
    since = time if not time.size or time[0] == 0 else time - time[0]
    length = float(since[-1]) if time.size else 0.0
    knots = None if length > 0 and not _rises(since) else _knots(since)
    if knots is not None:
        return Clock(None, knots, [float(f"{since[k]:.9g}") for k in knots])
    steps = np.diff(since)
    short = np.percentile(steps[steps > 0], 1, method="lower")
    ticks = int(min(np.ceil(_FINER * length / short), _MOST_TICKS))
    return Clock(np.round(since / length * ticks).astype(np.int64), [0, ticks], [0.0, length])


def _rises(since: np.ndarray) -> bool:
    return all((np.diff(since[a : b + 1]) > 0).all() for a, b in pieces(0, since.size - 1))


def _knots(since: np.ndarray) -> list[int] | None:
    """Return the samples between which sampling is uniform, by bisection at the largest deviation.

    After D. H. Douglas and T. K. Peucker, Cartographica 10, 112 (1973).
    """
    knots = {0, max(since.size - 1, 0)}
    parts = [(0, since.size - 1)]
    while parts:
        a, b = parts.pop()
        if b - a < 2:
            continue
        worst, off = _least_even(since, a, b)
        if off <= 1:
            continue
        knots.add(worst)
        if len(knots) > _MAX_KNOTS:
            return None
        parts += [(a, worst), (worst, b)]
    return sorted(knots)


def _least_even(since: np.ndarray, first: int, last: int) -> tuple[int, float]:
    """Return the sample that deviates most from uniform steps, and its relative deviation."""
    worst, most = first + 1, -np.inf
    rate = (since[last] - since[first]) / (last - first)
    for a, b in pieces(first + 1, last):  # a long record is not copied as a whole
        steps = np.diff(since[a - 1 : b + 1])
        even = since[first] + rate * np.arange(a - first, b - first)
        off = np.abs(since[a:b] - even) / (_WITHIN * np.minimum(steps[:-1], steps[1:]))
        if off.max() > most:
            worst, most = a + int(off.argmax()), float(off.max())
    return worst, most


def pack_points(place: np.ndarray, value: np.ndarray, *, deflate: bool) -> Json:
    """Return points packed for JSON: position steps, and values as 16-bit shares of their range.

    Parameters
    ----------
    place
        Positions of the points on the record's `Clock` (point).
    value
        In any unit (point).
    deflate
        Compress; data shown on opening the page are not, for browsers that cannot decompress.

    Returns
    -------
    dict
        Ready for JSON: ``points``, ``low`` and ``high`` of the values, ``step_bytes``,
        ``deflated``, and ``data``: the lowest bytes of all steps, the next bytes of all of them
        and so on, then likewise the two bytes of the values, as base64.

    Notes
    -----
    Grouping bytes by significance compresses best.
    """
    finite = value[np.isfinite(value)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    level = (value - low) / (high - low) if high > low else np.zeros(value.size)
    level = np.where(np.isfinite(value), np.round(np.nan_to_num(level) * _TOP), _TOP + 1)
    steps = np.diff(place, prepend=0)
    step_bytes = 2 if steps.max(initial=0) < 2**16 else 4
    raw = _planes(steps, step_bytes) + _planes(level, 2)
    return {
        "points": int(value.size),
        "low": low,
        "high": high,
        "step_bytes": step_bytes,
        "deflated": deflate,
        "data": deflated(raw) if deflate else base64.b64encode(raw).decode(),
    }


def _planes(whole: np.ndarray, width: int) -> bytes:
    return whole.astype(f"<u{width}").view(np.uint8).reshape(-1, width).T.tobytes()


def unpack_points(packed: Json) -> tuple[np.ndarray, np.ndarray]:
    """Return positions on the clock and values from `pack_points` (point).

    Examples
    --------
    >>> packed = pack_points(np.array([0, 3]), np.array([1.0, 2.0]), deflate=True)
    >>> [part.tolist() for part in unpack_points(packed)]
    [[0, 3], [1.0, 2.0]]
    """
    raw = base64.b64decode(packed["data"])
    raw = zlib.decompress(raw) if packed["deflated"] else raw
    width = packed["step_bytes"]
    planes = np.frombuffer(raw, np.uint8).reshape(width + 2, packed["points"]).astype(np.int64)
    level = planes[width] + 256 * planes[width + 1]
    values = packed["low"] + (packed["high"] - packed["low"]) * level / _TOP
    places = np.cumsum(256 ** np.arange(width) @ planes[:width])
    return places, np.where(level > _TOP, np.nan, values)
