"""Results of the segments of a run: columns, spectra on one grid, and a list of events."""

from __future__ import annotations

from typing import NamedTuple, TypeGuard

import numpy as np
import xarray as xr

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.examine import Examined
from tribolab.friction.oscillation.regularity import scatter
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR, NOT_LOOKED_AT

# columns that are numbers even for a segment without oscillation
_NOISE_COLUMNS = (
    "false_alarm_probability",
    "peak_prominence",
    "oscillation_swing",
    "oscillation_share",
    "background_noise",
    "sample_noise",
    "hysteresis",
    "spike_share",
    "mains_frequency",
    "mains_amplitude",
    "periods",
)


def ringing(kind: np.ndarray, frequency: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Return a mask of segments whose oscillation has the same frequency at all speeds.

    Parameters
    ----------
    kind
        Class of waveform; only a sinus-like oscillation is a resonance (segment).
    frequency, speed
        Frequency [Hz] and sliding speed [m/s] (segment).

    Returns
    -------
    ndarray
        True if other segments share the frequency within 3 % and their speeds differ by a factor of
        two or more (segment).

    Examples
    --------
    >>> kind = np.array(["sinus-like oscillation"] * 3)
    >>> ringing(kind, np.array([11.0, 11.1, 20.0]), np.array([1e-3, 3e-3, 3e-3])).tolist()
    [True, True, False]
    """
    sine = (kind == CLASSES[2]) & (frequency > 0) & (speed > 0)
    result = np.zeros(kind.size, bool)
    order = np.flatnonzero(sine)[np.argsort(frequency[sine], kind="stable")]
    logs = np.log(frequency[order])
    first = np.searchsorted(logs, logs - limits.MAX_CHANGE_OF_RESONANCE.value, side="left")
    last = np.searchsorted(logs, logs + limits.MAX_CHANGE_OF_RESONANCE.value, side="right")
    for k, (a, b) in enumerate(zip(first, last, strict=True)):
        near = speed[order[a:b]]
        result[order[k]] = near.max() >= limits.MIN_SPEED_RATIO_OF_RESONANCE.value * near.min()
    return result


class SlipRow(NamedTuple):
    """Results of one segment; `tribolab.friction.oscillation.slip_segments` explains each."""

    dominant_frequency: float
    dominant_frequency_sem: float
    dominant_wavelength: float
    dominant_wavelength_sem: float
    false_alarm_probability: float
    peak_prominence: float
    oscillation_swing: float
    oscillation_share: float
    background_noise: float
    sample_noise: float
    hysteresis: float
    harmonic_content: float
    drop: float
    drop_std: float
    stick_duration: float
    stick_duration_std: float
    slip_duration: float
    slip_duration_std: float
    recurrence_time: float
    recurrence_time_std: float
    recurrence_distance: float
    recurrence_distance_std: float
    loading_slope: float
    loading_stiffness: float
    fall_share: float
    asymmetry_p_value: float
    derivative_skewness: float
    period_scatter: float
    periods: float
    oscillating_time_share: float
    drop_scatter: float
    spike_share: float
    mains_frequency: float
    mains_amplitude: float


def class_of(examined: Examined | str) -> str:
    """Return the class of waveform, "not decided" or "not evaluated"."""
    return NOT_LOOKED_AT if isinstance(examined, str) else examined.verdict.kind


def ranked(examined: Examined) -> list[tuple[str, float]]:
    """Return the classes with their probabilities, the most probable first."""
    probability = examined.probability
    return [(CLASSES[k], float(probability[k])) for k in np.argsort(-probability)]


def class_table(examined: list[Examined | str]) -> np.ndarray:
    """Return the probability of each class (segment, class)."""
    nothing = np.full(len(CLASSES), np.nan)
    rows = [nothing if isinstance(e, str) else e.probability for e in examined]
    return np.array(rows).reshape(len(examined), len(CLASSES))


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else np.nan


def _std(values: np.ndarray) -> float:
    return float(values.std(ddof=1)) if values.size > 1 else np.nan


def _row(e: Examined, speed: float, load: float) -> SlipRow:
    o, w, events = e.oscillation, e.waveform, e.events
    stick, slip = events.peak - events.start, events.stop - events.peak
    period = e.regularity.periods
    frequency, error = e.verdict.frequency, e.verdict.frequency_error
    slope = e.loading_rate / speed if speed > 0 else np.nan
    mains = max(o.mains, key=lambda line: line.amplitude, default=None)
    return SlipRow(
        dominant_frequency=frequency,
        dominant_frequency_sem=error,
        dominant_wavelength=speed / frequency,
        dominant_wavelength_sem=speed / frequency * error / frequency,
        false_alarm_probability=o.false_alarm,
        peak_prominence=o.prominence,
        oscillation_swing=o.swing,
        oscillation_share=o.share,
        background_noise=o.noise,
        sample_noise=e.sample_noise,
        hysteresis=e.hysteresis,
        harmonic_content=o.harmonic_content,
        drop=_mean(events.drop),
        drop_std=_std(events.drop),
        stick_duration=_mean(stick),
        stick_duration_std=_std(stick),
        slip_duration=_mean(slip),
        slip_duration_std=_std(slip),
        recurrence_time=_mean(period),
        recurrence_time_std=_std(period),
        recurrence_distance=_mean(period) * speed,
        recurrence_distance_std=_std(period) * speed,
        loading_slope=slope,
        loading_stiffness=slope * (1.0 if e.force else load),
        fall_share=w.fall_share,
        asymmetry_p_value=w.asymmetry_p_value if w.events else np.nan,
        derivative_skewness=w.derivative_skewness,
        period_scatter=scatter(period),
        periods=e.verdict.periods,
        oscillating_time_share=e.regularity.share,
        drop_scatter=w.drop_scatter,
        spike_share=e.spike_share,
        mains_frequency=mains.frequency if mains else np.nan,
        mains_amplitude=mains.amplitude if mains else np.nan,
    )


def oscillates(seen: Examined | str) -> TypeGuard[Examined]:
    """Return whether a segment has a significant oscillation."""
    return class_of(seen) in CLASSES[1:]


def _count(seen: Examined | str) -> int:
    return seen.waveform.events if oscillates(seen) else 0


def slip_columns(
    examined: list[Examined | str], speed: np.ndarray, loads: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the numbers, class and method of all segments as columns (segment)."""
    nothing = SlipRow(*[np.nan] * len(SlipRow._fields))
    rows = [
        nothing if isinstance(e, str) else _row(e, v, n)
        for e, v, n in zip(examined, speed, loads, strict=True)
    ]
    kinds = [class_of(e) for e in examined]
    # without oscillation, turning points of the noise are neither drops nor periods
    rows = [
        nothing._replace(**{name: getattr(row, name) for name in _NOISE_COLUMNS})
        if kind in (CLASSES[0], NOT_CLEAR)
        else row
        for row, kind in zip(rows, kinds, strict=True)
    ]
    data = {name: np.array([getattr(row, name) for row in rows], float) for name in SlipRow._fields}
    data["events"] = np.array([_count(e) for e in examined], int)
    data["waveform"] = np.array(kinds, dtype=object)
    regular = [e.regularity.kind if oscillates(e) else "" for e in examined]
    data["regularity"] = np.array(regular, dtype=object)
    method = ["" if isinstance(e, str) else e.oscillation.method for e in examined]
    data["method"] = np.array(method, dtype=object)
    return data


def line_table(examined: list[Examined | str], speed: np.ndarray) -> xr.Dataset:
    """Return a table of the significant oscillations (segment, line), the strongest first.

    Parameters
    ----------
    examined, speed
        Results of `examine_record`, and the sliding speed [m/s] (segment).
    """
    lines = [e.lines if oscillates(e) else () for e in examined]
    columns = {name: np.full((len(examined), limits.MAX_LINES.value), np.nan) for name in _LINE}
    for k, mine in enumerate(lines):
        for n, line in enumerate(mine):
            columns["line_frequency"][k, n] = line.frequency
            columns["line_wavelength"][k, n] = speed[k] / line.frequency
            columns["line_swing"][k, n] = line.swing
            columns["line_false_alarm_probability"][k, n] = line.false_alarm
    return xr.Dataset({name: (("segment", "line"), values) for name, values in columns.items()})


_LINE = ("line_frequency", "line_wavelength", "line_swing", "line_false_alarm_probability")


def spectra_table(examined: list[Examined | str], speed: np.ndarray) -> xr.Dataset:
    """Return all spectra on common logarithmic grids of frequency and of inverse wavelength."""
    names = {"psd": "power", "psd_background": "background", "psd_significant": "level"}
    seen = [None if isinstance(e, str) else e.oscillation for e in examined]
    data = {}
    frequency = _grid([o.bands for o in seen if o is not None])
    for name, field in names.items():
        rows = [_interpolated(frequency, o.bands, getattr(o, field)) if o else None for o in seen]
        data[name] = ("segment", "frequency"), _stack(rows, frequency.size)
    places = [o.bands / v if o and v > 0 else None for o, v in zip(seen, speed, strict=True)]
    inverse = _grid([place for place in places if place is not None])
    rows = [
        None if place is None or o is None else _interpolated(inverse, place, v * o.power)
        for o, place, v in zip(seen, places, speed, strict=True)
    ]
    data["distance_psd"] = ("segment", "inverse_wavelength"), _stack(rows, inverse.size)
    return xr.Dataset(data, {"frequency": frequency, "inverse_wavelength": inverse})


def _grid(axes: list[np.ndarray]) -> np.ndarray:
    if not axes:
        return np.zeros(0)
    first = np.floor(limits.BANDS_PER_DECADE.value * np.log10(min(a[0] for a in axes)))
    last = np.ceil(limits.BANDS_PER_DECADE.value * np.log10(max(a[-1] for a in axes)))
    return 10 ** (np.arange(first, last + 1) / limits.BANDS_PER_DECADE.value)


def _interpolated(grid: np.ndarray, axis: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Return a spectrum interpolated to a grid on log-log scales; NaN beyond its ends."""
    log = np.log(np.maximum(power, 1e-300))
    return np.exp(np.interp(np.log(grid), np.log(axis), log, left=np.nan, right=np.nan))


def _stack(rows: list[np.ndarray | None], size: int) -> np.ndarray:
    nothing = np.full(size, np.nan)
    return np.array([nothing if row is None else row for row in rows]).reshape(len(rows), size)


def event_list(examined: list[Examined | str]) -> xr.Dataset:
    """Return all events of a run in temporal order."""
    seen = [
        (number, e.events)
        for number, e in enumerate(examined)
        if not isinstance(e, str) and oscillates(e)
    ]
    number = [np.full(e.peak.size, k) for k, e in seen]
    columns = {
        "event_segment": (number, int),
        "event_time": ([e.peak for _, e in seen], float),
        "event_drop": ([e.drop for _, e in seen], float),
        "event_stick": ([e.peak - e.start for _, e in seen], float),
        "event_slip": ([e.stop - e.peak for _, e in seen], float),
    }
    empty = np.zeros(0)
    return xr.Dataset(
        {
            name: ("event", np.concatenate([*parts, empty]).astype(kind))
            for name, (parts, kind) in columns.items()
        }
    )
