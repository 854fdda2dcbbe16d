"""Analysis of the oscillation of one record: spectrum, stick-slip events, and waveform."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.components import Component, components
from tribolab.friction.oscillation.events import Events, find_events, loading_rate, without_spikes
from tribolab.friction.oscillation.few_periods import slow_wave, without_slow_wave
from tribolab.friction.oscillation.mean_cycle import abrupt_drop, abrupt_rise, smooth_drop
from tribolab.friction.oscillation.oscillation import Oscillation, oscillation
from tribolab.friction.oscillation.periods import PeriodVerdict, at_odds, period_verdict
from tribolab.friction.oscillation.regularity import SLIP_KINDS, Regularity, regularity, scatter
from tribolab.friction.oscillation.spectrum.noise import noise_level, quantisation_step
from tribolab.friction.oscillation.spectrum.spectra import EvenRecord, coarsened, make_record
from tribolab.friction.oscillation.spectrum.survey import Survey, survey
from tribolab.friction.oscillation.waveform import (
    WaveformFeatures,
    class_probabilities,
    describe_waveform,
    features,
)

# fewest samples per period in the search for events; records with more are averaged
_SAMPLES_PER_PERIOD = 36
_COARSE_SAMPLES_PER_PERIOD = 12  # the same, if noise splits drops into several
_EVENT_SAMPLES = 1 << 17  # most samples searched for events: thousands of periods
# spikes are not removed from longer records, as single samples hardly matter
_DESPIKED_SAMPLES = 1 << 20
_SIMULATED_CYCLES = 200  # simulated cycles that determine the bias due to noise
_SIMULATION_ROUNDS = 2


class Examined(NamedTuple):
    """Results of the analysis of one record, in the signal's unit."""

    oscillation: Oscillation
    events: Events
    waveform: WaveformFeatures
    regularity: Regularity
    probability: np.ndarray
    verdict: PeriodVerdict
    lines: tuple[Component, ...]
    hysteresis: float
    sample_noise: float
    spike_share: float
    loading_rate: float
    force: bool = False


class View(NamedTuple):
    """Oscillation with its cycles, and the record in which they were found."""

    oscillation: Oscillation
    record: EvenRecord
    events: Events
    hysteresis: float
    regularity: Regularity


def examine_record(time: np.ndarray, values: np.ndarray, *, force: bool = False) -> Examined | str:
    """Return the analysis of one record, or the reason why it cannot be analysed.

    Parameters
    ----------
    time, values
        [s], and friction, positive as resistance (time).
    force
        Whether the values are a force [N]; stored in the result.
    """
    record = make_record(time, values)
    n = record.values.size
    if n < limits.MIN_SAMPLES_OF_RECORD.value:
        return f"{n} samples are too few"
    least = 1e-12 * abs(record.values[0])
    if np.ptp(record.values[:4096]) <= least and np.ptp(record.values) <= least:
        return "the signal is constant"
    noise, spikes = noise_level(record.values[: 1 << 17]), 0
    if n <= _DESPIKED_SAMPLES:
        kept, spikes = without_spikes(record.values, noise)
        record = record._replace(values=kept)
    surveyed = survey(record)
    if surveyed is None:
        return "too short for a spectrum"
    view, slow = _best_view(record, surveyed, noise), slow_wave(record)
    if slow is None and not view.oscillation.false_alarm < limits.BAND_BY_CHANCE.value:
        record, surveyed, view = _without_slow_wave(record, surveyed, view, noise)
    oscillation, part, events = view.oscillation, view.record, view.events
    lag = max(1, int(round(1 / (oscillation.frequency * 16 * part.spacing))))
    form = describe_waveform(part.values, lag, events, view.regularity.periods)
    probability = class_probabilities(features(form, oscillation))
    if events.drop.size:
        excess = _excess(record, view, form, probability)
        swing = np.ptp(record.values)  # a drop extrapolated from the mean cycle may exceed it
        drop, rise = (np.minimum(x - excess, swing) for x in (events.drop, events.rise))
        events = events._replace(drop=drop, rise=rise)
    lines = components(surveyed)
    seen = period_verdict(
        probability, oscillation, view.regularity, slow, lines, surveyed.duration, form
    )
    return Examined(
        oscillation, events, form, view.regularity, probability, seen, lines,
        view.hysteresis, noise, spikes / n,
        loading_rate(part.time, part.values, events), force,
    )  # fmt: skip


def _best_view(record: EvenRecord, surveyed: Survey, noise: float) -> View:
    """Return oscillation and cycles at the period of the strongest line, or at a more regular one.

    In a record of few sawtooth periods the second harmonic may be the strongest significant line:
    then the drops repeat at another period, and the spectrum is examined there. Slow drift or noise
    may hide or split drops: then they are searched for in means, and without the drift.
    """
    view = _view(record, oscillation(surveyed), noise)
    if at_odds(view.oscillation, view.regularity):
        own = 1 / float(view.regularity.periods.mean())
        again = _view(record, oscillation(surveyed, near=own), noise)
        if not at_odds(again.oscillation, again.regularity):
            view = again
    # slow drift minus its running mean also oscillates, at a period near the averaging time
    sure = view.oscillation.false_alarm < limits.BAND_BY_CHANCE.value
    if sure and view.regularity.kind not in SLIP_KINDS[::2]:
        for part in (record, _without_wander(record, view.oscillation)):
            if part is None:
                continue
            again = _view(part, view.oscillation, noise, _COARSE_SAMPLES_PER_PERIOD)
            less = scatter(
                again.regularity.periods
            ) < limits.MAX_SCATTER_WITHOUT_WANDER.value * scatter(view.regularity.periods)
            if less and not at_odds(again.oscillation, again.regularity):
                view = again
    return view


def _without_slow_wave(
    record: EvenRecord, surveyed: Survey, view: View, noise: float
) -> tuple[EvenRecord, Survey, View]:
    """Return a record without a slow wave, if a larger regular oscillation remains."""
    rest = without_slow_wave(record)
    found = survey(rest[0]) if rest else None
    if rest is None or found is None:
        return record, surveyed, view
    again = _best_view(rest[0], found, noise)
    sure = (
        again.oscillation.false_alarm < limits.BAND_BY_CHANCE.value
        and again.oscillation.swing > rest[1]
    )
    regular = again.regularity.kind == SLIP_KINDS[0]
    if sure and regular and not at_odds(again.oscillation, again.regularity):
        return rest[0], found, again
    return record, surveyed, view


def _without_drift(record: EvenRecord, frequency: float) -> EvenRecord:
    """Return a record minus drift slower than its oscillation, which biases rises and drops."""
    periods = frequency * record.values.size * record.spacing
    degree = int(
        np.clip(
            periods / limits.PERIODS_PER_DEGREE_OF_DRIFT.value, 1, limits.MAX_DEGREE_OF_DRIFT.value
        )
    )
    series = np.polynomial.legendre
    if record.even:  # the basis is nearly orthogonal: normal equations are accurate
        terms = series.legvander(np.linspace(-1, 1, record.values.size), degree)
        drift = terms @ np.linalg.solve(terms.T @ terms, terms.T @ record.values)
    else:
        place = 2 * (record.time - record.time[0]) / np.ptp(record.time) - 1
        drift = series.legval(place, series.legfit(place, record.values, degree))
    return record._replace(values=record.values - drift)


def _without_wander(record: EvenRecord, oscillation: Oscillation) -> EvenRecord | None:
    """Return a record minus its running mean over one period; None if there is hardly any drift.

    A wave's mean over its own period is constant, so that its cycles do not change. Half a period
    is lost at each end.
    """
    size = int(round(1 / (oscillation.frequency * record.spacing)))
    n = record.values.size
    if not 2 <= size <= n / limits.MIN_PERIODS_TO_REMOVE_DRIFT.value or not record.even:
        return None
    sums = np.concatenate([[0.0], np.cumsum(record.values - record.values[0])])
    mean = (sums[size:] - sums[:-size]) / size
    if np.std(mean) < limits.MIN_WANDER_OVER_SWING.value * oscillation.swing:
        return None
    first = size // 2
    part = slice(first, first + mean.size)
    return EvenRecord(record.time[part], record.values[part] - mean, *record[2:])


def _view(
    record: EvenRecord, oscillation: Oscillation, noise: float, fewest: int = _SAMPLES_PER_PERIOD
) -> View:
    """Return an oscillation with its cycles, found in a record averaged to suit its period."""
    most = int(1 / (oscillation.frequency * fewest * record.spacing))
    # average only as much as the noise requires, because means round off abrupt falls
    wanted = min(limits.SWING_OVER_NOISE.value * noise / max(oscillation.swing, 1e-300), 1e6) ** 2
    size = int(max(1, min(most, wanted)))
    first = slice(_EVENT_SAMPLES * size)
    part = coarsened(EvenRecord(record.time[first], record.values[first], *record[2:]), size)
    part = _without_drift(part, oscillation.frequency)
    step = quantisation_step(record.values[: 1 << 16])
    hysteresis = max(
        limits.MIN_EVENT_OVER_SWING.value * oscillation.swing,
        limits.MIN_EVENT_OVER_NOISE.value * noise / np.sqrt(size),
        limits.MIN_DROP_IN_STEPS.value * step,
    )
    events = find_events(part.time, part.values, hysteresis)
    # irregular cycles have a weak line: choose the hysteresis by the size of the drops
    if events.drop.size:
        typical = limits.MIN_EVENT_OVER_SWING.value * float(np.mean(events.drop))
        if typical > hysteresis:
            hysteresis = typical
            events = find_events(part.time, part.values, hysteresis)
    fall, whole = events.stop - events.peak, events.stop - events.start
    # periods are counted between the sharp edges, which are the rises of a reversed sawtooth
    if events.drop.size and median(fall / whole) > limits.MIN_FALL_OF_REVERSED_WAVE.value:
        turned = part._replace(values=-part.values)
        seen = regularity(turned, find_events(turned.time, turned.values, hysteresis))
    else:
        seen = regularity(part, events)
    return View(oscillation, part, events, hysteresis, seen)


def _excess(
    record: EvenRecord, view: View, form: WaveformFeatures, probability: np.ndarray
) -> float:
    """Return the bias of the mean drop when it is measured from peak to valley."""
    if probability[0] >= 0.5:
        return 0.0
    oscillation, events = view.oscillation, view.events
    mean = float(np.mean(events.drop))
    # the mean cycle is used if all cycles are alike, without a pause
    if (
        form.period_scatter < limits.MAX_SCATTER_OF_SURE_PERIODS.value
        and view.regularity.periods.size == events.drop.size - 1
    ):
        means = {1: abrupt_drop, 2: smooth_drop, 3: abrupt_rise}.get(int(np.argmax(probability)))
        # less averaging, because means round off abrupt falls
        finer = max(1, round(view.record.spacing / record.spacing) // 2)
        last = int(view.record.values.size * round(view.record.spacing / record.spacing))
        part = EvenRecord(record.time[:last], record.values[:last], *record[2:])
        drop = means(coarsened(part, finer), events) if means else np.nan
        if 0.25 * mean < drop < 1.25 * mean:
            return mean - drop
    # the power of a sine, minus that of the noise, gives its size best
    sine = float(np.clip((0.35 - oscillation.harmonic_content) / 0.2, 0.0, 1.0))
    if (
        view.regularity.kind == SLIP_KINDS[2]
    ):  # the power also includes the quiet time between trains of oscillation
        sine = 0.0
    excess = 0.0
    if sine < 1:
        excess = min(noise_excess(view.record, oscillation, events, view.hysteresis), 0.5 * mean)
    return sine * (mean - oscillation.swing) + (1 - sine) * excess


def noise_excess(
    record: EvenRecord, oscillation: Oscillation, events: Events, hysteresis: float
) -> float:
    """Return the bias of the mean drop due to noise.

    Parameters
    ----------
    record
        The record in which the events were found.
    oscillation
        Oscillation with its background.
    events
        Events of the record.
    hysteresis
        Smallest swing that counts.

    Returns
    -------
    float
        Bias in the signal's unit.

    Notes
    -----
    Turning points are extremes, so that noise increases the drop. The bias depends on the waveform,
    the noise and the sampling rate, and is found by simulation: noise drawn from the background's
    spectrum is added to straight lines between the turning points, and cycles are searched for
    again. Harmonics may have been counted as noise: the residuals about the straight lines give its
    true size. Noise slower than half the oscillation's frequency moves peaks and valleys alike and
    is left out.
    """
    # a limited number of events is sufficient for a long record
    events = Events(*(part[:_SIMULATED_CYCLES] for part in events))
    n = int(np.searchsorted(record.time, events.stop[-1])) + 1
    frequency = np.fft.rfftfreq(n, record.spacing)
    density = np.interp(frequency, oscillation.bands, oscillation.background)
    density[frequency < 0.5 * oscillation.frequency] = 0.0
    height = np.sqrt(density * n / (4 * record.spacing))
    time, cycles, rest = _cycles(record.time, record.values, events)
    inside = np.searchsorted(record.time, time[0])
    rng = np.random.default_rng(0)
    for _ in range(_SIMULATION_ROUNDS):
        drops, rests = [np.zeros(0)], []
        for _ in range(int(np.clip(_SIMULATED_CYCLES / events.drop.size, 1, 32))):
            draw = rng.standard_normal((2, height.size))
            noise = np.fft.irfft(height * (draw[0] + 1j * draw[1]), n)
            noisy = cycles + noise[inside : inside + time.size]
            again = find_events(time, noisy, hysteresis)
            drops.append(again.drop)
            if again.drop.size:
                rests.append(_cycles(time, noisy, again)[2])
        if not sum(rests) > 0:  # no cycles are left, or no noise was added to them
            return 0.0
        height *= min(rest * len(rests) / sum(rests), 1.0)
    return float(np.concatenate(drops).mean() - events.drop.mean())


def _cycles(
    time: np.ndarray, values: np.ndarray, events: Events
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return times within the events, values on lines between turning points, and residuals."""
    knots = np.append(np.stack([events.start, events.peak], axis=1).ravel(), events.stop[-1])
    first, last = np.searchsorted(time, knots[[0, -1]])
    time, values = time[first : last + 1], values[first : last + 1]
    lines = np.interp(time, knots, values[np.searchsorted(time, knots)])
    return time, lines, float(np.sqrt(np.mean((values - lines) ** 2)))
