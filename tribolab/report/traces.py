"""The traces that the page zooms into: few points, no spike lost, packed as text."""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.plot.labels import speed_text
from tribolab.plot.reduce import envelope_index
from tribolab.plot.signals import main_signal
from tribolab.qc.flags import FAIL, SUSPECT
from tribolab.quantities import quantity

if TYPE_CHECKING:
    import xarray as xr

_MOTION = {"sliding_velocity": "velocity", "set_speed": "set speed", "position": "position"}
_LAST = 2**32 - 1  # a time of the trace, as a share of its length
_TOP = 65534  # a value, as a share of its range; 65535 is "not a number"
_MOST_SPANS = 400
_SIGNAL_BYTES = 2 * 8  # of a point of two signals: six bytes each, as text eight
_PAGE_BYTES, _FILES_BYTES = 6e6, 100e6


def trace_points(runs: int) -> tuple[int, int]:
    """Return how many points a signal may have in the page and in the file beside it.

    The page of many runs shall stay one that can be sent, and all traces beside it a tenth of a
    gigabyte.

    Examples
    --------
    >>> trace_points(5), trace_points(200), trace_points(2000)
    ((4000, 24000), (1875, 24000), (1000, 3125))
    """
    points = _PAGE_BYTES // (_SIGNAL_BYTES * max(runs, 1))
    fine = _FILES_BYTES // (_SIGNAL_BYTES * max(runs, 1))
    return int(np.clip(points, 1000, 4000)), int(min(fine, 24_000))


def trace(
    run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset | None, points: int
) -> dict[str, Any]:
    """Return a run's trace for the page: signals over time, segments and flagged spans.

    Parameters
    ----------
    run, segments, friction
        A run (time) and its results (segment).
    points
        About so many points of each signal are kept. Half of them are the extremes of equal
        parts of the record, half those of equal parts of each segment, so that a fast stroke
        can be zoomed into as a slow one can.

    Returns
    -------
    dict
        Ready for JSON; `assets/chart.js` reads it. ``complete`` says that nothing was left out.

    Raises
    ------
    AnalysisError
        If the run has neither a friction force nor a friction coefficient.
    """
    time = np.asarray(run["time"], float)
    bounds = np.c_[np.asarray(segments["start"], float), np.asarray(segments["stop"], float)]
    main = main_signal(run, friction)
    signals = [(main.name, main.values)]
    for name in _MOTION:
        if name in run and np.ptp(np.asarray(run[name], float)) > 0:
            signals.append((name, np.asarray(run[name], float)))
            break
    packed = []
    for name, values in signals:
        chosen = _chosen(time, values, bounds, points)
        known = quantity(name)
        # speeds span decades: packed as they are drawn, linear only below the slowest segment
        below = _slowest(segments) if name in ("sliding_velocity", "set_speed") else None
        levels = values if below is None else np.arcsinh(values / below)
        packed.append(
            {
                "name": name,
                "label": _MOTION.get(name, known.long_name),
                "unit": "" if known.unit == "1" else known.unit,
                "linear_below": below,
                **_packed(time[chosen], levels[chosen], time),
            }
        )
    return {
        "length_s": float(time[-1] - time[0]) if time.size else 0.0,
        "samples": int(time.size),
        "complete": all(signal["points"] == time.size for signal in packed),
        "signals": packed,
        "segments": _segments(segments, friction, main.name),
        "flags": flagged_spans(run),
    }


def _chosen(time: np.ndarray, values: np.ndarray, bounds: np.ndarray, points: int) -> np.ndarray:
    if time.size <= points:
        return np.arange(time.size)
    parts = [envelope_index(time, values, points // 4)]
    first = np.searchsorted(time, bounds[:, 0], "left")
    last = np.searchsorted(time, bounds[:, 1], "right")
    columns = max(2, points // 4 // max(len(bounds), 1))
    for a, b in zip(first, last, strict=True):
        if b - a > 1:
            parts.append(a + envelope_index(time[a:b], values[a:b], columns))
    return np.unique(np.concatenate([*parts, [0, time.size - 1]]))


def _packed(x: np.ndarray, y: np.ndarray, time: np.ndarray) -> dict[str, Any]:
    """Pack points: times as shares of the record in 32 bits, values as shares of their range."""
    finite = y[np.isfinite(y)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    length, span = time[-1] - time[0], high - low
    share = (x - time[0]) / length if length > 0 else np.zeros(x.size)
    level = (y - low) / span if span > 0 else np.zeros(y.size)
    level = np.where(np.isfinite(y), np.round(np.nan_to_num(level) * _TOP), _TOP + 1)
    raw = np.round(share * _LAST).astype("<u4").tobytes() + level.astype("<u2").tobytes()
    return {
        "points": int(x.size),
        "low": low,
        "high": high,
        "data": base64.b64encode(raw).decode(),
    }


def _slowest(segments: xr.Dataset) -> float | None:
    speed = np.asarray(segments["sliding_speed"], float)
    speed = speed[np.isfinite(speed) & (speed > 0)]
    return float(speed.min()) if speed.size else None


def _segments(segments: xr.Dataset, friction: xr.Dataset | None, name: str) -> list[list[Any]]:
    """Start, stop, both after trimming, direction, mean where the trace runs, and the speed."""
    names = ("start", "stop", "trimmed_start", "trimmed_stop")
    bounds = np.column_stack([np.asarray(segments[n], float) for n in names])
    direction = np.asarray(segments["direction"], int)
    mean = np.full(direction.size, np.nan)
    if friction is not None and name in friction:
        mean = np.asarray(friction[name], float)
        if name == "friction_coefficient":
            mean = mean * np.where(direction == 0, 1, direction)
    speeds = np.asarray(segments["sliding_speed"], float)
    return [
        [*map(_short, ends), int(sign), _short(value), speed_text(speed)]
        for ends, sign, value, speed in zip(bounds, direction, mean, speeds, strict=True)
    ]


def _short(value: float) -> float | None:
    return float(f"{value:.9g}") if np.isfinite(value) else None


def flagged_spans(run: xr.Dataset) -> list[dict[str, Any]]:
    """Return where checks objected to a run's signals.

    Parameters
    ----------
    run
        A run with ``<signal>_qc`` flags.

    Returns
    -------
    list of dict
        ``signal``, ``severity`` (suspect or fail), ``start_s``, ``stop_s`` and ``checks``. Spans
        nearer to each other than a thousandth of the record are one, and of very many only the
        longest are kept.
    """
    time = np.asarray(run["time"], float)
    if time.size < 2:
        return []
    near = (time[-1] - time[0]) / 1000
    spans = []
    for name in sorted(str(n) for n in run.data_vars if f"{n}_qc" in run):
        flags = np.asarray(run[f"{name}_qc"])
        tests = np.asarray(run[f"{name}_qc_tests"]) if f"{name}_qc_tests" in run else None
        for severity, code in (("suspect", SUSPECT), ("fail", FAIL)):
            hit = np.flatnonzero(flags == code)
            if not hit.size:
                continue
            breaks = np.flatnonzero(np.diff(time[hit]) > near)
            for part in np.split(hit, breaks + 1):
                spans.append(
                    {
                        "signal": name,
                        "severity": severity,
                        "start_s": _short(time[part[0]]),
                        "stop_s": _short(time[part[-1]]),
                        "checks": [] if tests is None else _checks(run, name, tests[part]),
                    }
                )
    longest = sorted(spans, key=lambda span: span["start_s"] - span["stop_s"])[:_MOST_SPANS]
    return sorted(longest, key=lambda span: span["start_s"])


def _checks(run: xr.Dataset, name: str, tests: np.ndarray) -> list[str]:
    attrs = run[f"{name}_qc_tests"].attrs
    masks = np.atleast_1d(np.asarray(attrs.get("flag_masks", [])))
    words = str(attrs.get("flag_meanings", "")).split()
    seen = np.bitwise_or.reduce(tests)
    return [word for mask, word in zip(masks, words, strict=False) if int(mask) & int(seen)]


def as_text(data: Any) -> str:
    """Return data as JSON that may stand in a script element: nothing in it can end that."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
