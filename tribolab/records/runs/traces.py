"""Traces for zooming on the page: few points that keep every spike, packed as text."""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribolab.arrays.chunks import one_by_one, samples_where
from tribolab.arrays.scratch import let_go
from tribolab.core.untyped import Json
from tribolab.core.wording import speed_text
from tribolab.figures.envelopes import envelope_index, extremes_index
from tribolab.figures.signals import Signal, main_signal
from tribolab.qc.flags import FAIL, SUSPECT
from tribolab.records.packed import Clock, clock_of, pack_points
from tribolab.records.parts import FlaggedSpan, PageTrace
from tribolab.units.quantities import quantity

if TYPE_CHECKING:
    import xarray as xr

_MOTION = {"sliding_velocity": "velocity", "set_speed": "set speed", "position": "position"}
_LABELS = {**_MOTION, "inertial_force": "inertia"}
_MAX_SPANS = 400
_FINE_CHARACTERS = 4.0  # upper estimate per point of two noisy signals, compressed
_FEWER = 1.3  # points ~ bytes^1.3: fewer points compress worse
_FINEST = 24_000  # points of a signal available for zooming
_POINT_BYTES = 8.0  # bytes per point of two signals, compressed and as text
_BYTES, _FULL_SIZE_RUNS = 1.25e6, 32  # bytes of all traces together, for up to this many runs
_MIN_FINER = 3400  # bytes; a smaller trace for zooming shows hardly more than the first one
_COARSE_SHARE = 0.3  # share of the bytes for the points shown on opening


def page_trace(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None,
    points: int,
    fine_size: int,
) -> PageTrace:
    """Trace of a run for the page; parameters as of `decimated_trace` and `finer_trace`."""
    shared = shared_trace(run, friction)
    return PageTrace(
        script_json(decimated_trace(run, segments, friction, points, shared)),
        finer_trace(run, segments, friction, points, fine_size, shared),
    )


class SharedTrace(NamedTuple):
    """Data shared by a trace and its finer one: clock and main signal."""

    clock: Clock
    main: Signal


def shared_trace(run: xr.Dataset, friction: xr.Dataset | None) -> SharedTrace:
    """Return the data that all traces of a run share.

    Raises
    ------
    AnalysisError
        If the run has neither a friction force nor a friction coefficient.
    """
    return SharedTrace(clock_of(np.asarray(run["time"], float)), main_signal(run, friction))


def trace_size(runs: int) -> tuple[int, int]:
    """Return the number of points of a signal shown on opening, and size of its finer trace.

    This limits the size of a page with many runs.

    Returns
    -------
    points
        Points of each signal shown when a run is opened.
    size
        Size of the finer trace, in characters of the page.

    Notes
    -----
    The number of runs is rounded up to a power of two, so that one more run rarely changes the
    traces of the others.

    Examples
    --------
    >>> trace_size(5), trace_size(200), trace_size(2000)
    ((2000, 109375), (366, 6835), (300, 3400))
    """
    runs = 1 << max(runs - 1, 0).bit_length()
    # with many runs the page grows, but more slowly than their number
    each = _BYTES * max(1.0, (runs / _FULL_SIZE_RUNS) ** (1 / 3)) / runs
    points = _COARSE_SHARE * each / _POINT_BYTES
    return int(np.clip(points, 300, 2000)), max(int((1 - _COARSE_SHARE) * each), _MIN_FINER)


def decimated_trace(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None,
    points: int,
    shared: SharedTrace | None = None,
) -> Json:
    """Return a run's trace for the page: signals over time, segments and flagged spans.

    Parameters
    ----------
    run, segments, friction
        A run (time) and its results (segment).
    points
        Approximate number of points of each signal. Half of them are the extremes of equal parts of
        the record, half those of equal parts of each segment, so that fast strokes can be zoomed
        like slow ones.
    shared
        Data of the run already computed.

    Returns
    -------
    dict
        Ready for JSON; `assets/trace.js` reads it. ``complete`` states that it contains all points.

    Raises
    ------
    AnalysisError
        If the run has neither a friction force nor a friction coefficient.
    """
    time = np.asarray(run["time"], float)
    shared = shared or shared_trace(run, friction)
    return {
        "length_s": float(time[-1] - time[0]) if time.size else 0.0,
        "samples": int(time.size),
        "clock": [shared.clock.knots, shared.clock.at_s],
        **_signals(run, segments, shared, points),
        "segments": _segments(segments, friction, shared.main.name),
        "flags": [asdict(span) for span in flagged_spans(run)],
    }


def finer_trace(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset | None,
    points: int,
    size: int,
    shared: SharedTrace | None = None,
) -> str:
    """Return the signals of a run with as many points as fit, for zooming on the page.

    Parameters
    ----------
    run, segments, friction
        As for `decimated_trace`.
    points
        Points of the trace shown on opening; a finer trace needs more.
    size
        Largest length of the text [characters]; the number of points is reduced to meet it.
    shared
        Data of the run already computed.

    Returns
    -------
    str
        ``complete`` and ``signals`` as from `decimated_trace`, compressed, as JSON that is safe in
        a script element; "" if that trace is complete or no finer one fits.
    """
    shared = shared or shared_trace(run, friction)
    finer = min(_FINEST, int(size / _FINE_CHARACTERS)) if run.sizes["time"] > points else 0
    while finer > points:
        text = script_json(_signals(run, segments, shared, finer))
        if len(text) <= size:
            return text
        finer = int(finer * (size / len(text)) ** _FEWER)
    return ""


def _signals(run: xr.Dataset, segments: xr.Dataset, shared: SharedTrace, points: int) -> Json:
    time = np.asarray(run["time"], float)
    bounds = np.c_[np.asarray(segments["start"], float), np.asarray(segments["stop"], float)]
    clock, main = shared
    signals = [(main.name, main.values)]
    for name in _MOTION:
        if name in run and _varies(np.asarray(run[name], float)):
            signals.append((name, np.asarray(run[name], float)))
            break
    if "inertial_force" in run:
        signals.append(("inertial_force", np.asarray(run["inertial_force"], float)))
    let_go()
    packed = []
    for name, values in one_by_one(signals):
        chosen = _chosen(time, values, bounds, points)
        known = quantity(name)
        # speeds cover decades: scaled as drawn, linear only below the speed of the slowest segment
        below = _slowest(segments) if name in ("sliding_velocity", "set_speed") else None
        levels = values[chosen] if below is None else np.arcsinh(values[chosen] / below)
        packed.append(
            {
                "name": name,
                "label": _LABELS.get(name, known.long_name),
                "unit": "" if known.unit == "1" else known.unit,
                "linear_below": below,
                **pack_points(clock.places(chosen), levels, deflate=True),
            }
        )
    return {
        "complete": all(signal["points"] == time.size for signal in packed),
        "signals": packed,
    }


def _varies(values: np.ndarray) -> bool:
    """Return whether a signal has more than one value, ignoring gaps."""
    return bool(np.fmax.reduce(values) > np.fmin.reduce(values))


def _chosen(time: np.ndarray, values: np.ndarray, bounds: np.ndarray, points: int) -> np.ndarray:
    if time.size <= points:
        return np.arange(time.size)
    parts = [envelope_index(time, values, points // 4)]
    first = np.searchsorted(time, bounds[:, 0], "left")
    last = np.searchsorted(time, bounds[:, 1], "right")
    if len(bounds):
        columns = max(2, points // 4 // len(bounds))
        within = np.linspace(first, last, columns + 1).astype(int)
        starts = np.unique(within)
        parts.append(extremes_index(values, starts[starts < time.size]))
    chosen = np.sort(np.concatenate([*parts, [0, time.size - 1]]))
    # unique values without hashing by `numpy.unique`
    return chosen[np.diff(chosen, prepend=-1) > 0]


def _slowest(segments: xr.Dataset) -> float | None:
    speed = np.asarray(segments["sliding_speed"], float)
    speed = speed[np.isfinite(speed) & (speed > 0)]
    return float(speed.min()) if speed.size else None


def _segments(segments: xr.Dataset, friction: xr.Dataset | None, name: str) -> list[list[Any]]:
    """Return rows: start, stop, trimmed start and stop, direction, mean of the trace, speed."""
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


def flagged_spans(run: xr.Dataset) -> list[FlaggedSpan]:
    """Return the intervals in which checks objected to a run's signals.

    Parameters
    ----------
    run
        A run with ``<signal>_qc`` flags.

    Returns
    -------
    list of FlaggedSpan
        ``signal``, ``severity`` (suspect or fail), ``start_s``, ``stop_s`` and ``checks``. Spans
        closer than a thousandth of the record are merged, and only the longest are kept if there
        are very many.
    """
    time = np.asarray(run["time"], float)
    if time.size < 2:
        return []
    near = (time[-1] - time[0]) / 1000
    spans: list[FlaggedSpan] = []
    for name in one_by_one(sorted(str(n) for n in run.data_vars if f"{n}_qc" in run)):
        flags = np.asarray(run[f"{name}_qc"])
        tests = np.asarray(run[f"{name}_qc_tests"]) if f"{name}_qc_tests" in run else None
        for severity, code in (("suspect", SUSPECT), ("fail", FAIL)):
            hit = samples_where(partial(np.equal, code), flags)
            if not hit.size:
                continue
            breaks = np.flatnonzero(np.diff(time[hit]) > near)
            for part in np.split(hit, breaks + 1):
                spans.append(
                    FlaggedSpan(
                        signal=name,
                        severity=severity,
                        start_s=float(f"{time[part[0]]:.9g}"),
                        stop_s=float(f"{time[part[-1]]:.9g}"),
                        checks=() if tests is None else _checks(run, name, tests[part]),
                    )
                )
    longest = sorted(spans, key=lambda span: span.start_s - span.stop_s)[:_MAX_SPANS]
    return sorted(longest, key=lambda span: span.start_s)


def _checks(run: xr.Dataset, name: str, tests: np.ndarray) -> tuple[str, ...]:
    attrs = run[f"{name}_qc_tests"].attrs
    masks = np.atleast_1d(np.asarray(attrs.get("flag_masks", [])))
    words = str(attrs.get("flag_meanings", "")).split()
    seen = np.bitwise_or.reduce(tests)
    pairs = zip(masks, words, strict=False)
    return tuple(word for mask, word in pairs if int(mask) & int(seen))


def script_json(data: Any) -> str:
    """Return JSON text that is safe in a script element."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
