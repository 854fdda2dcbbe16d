"""One record seen whole: oscillation, events and form at the scale of its own period."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.events import Events, find_events, without_spikes
from tribolab.friction.mean_cycle import abrupt_drop, smooth_drop
from tribolab.friction.noise import noise_level, quantisation_step
from tribolab.friction.oscillation import Oscillation, oscillation
from tribolab.friction.spectra import Record, coarse, make_record
from tribolab.friction.waveform import (
    Waveform,
    class_probabilities,
    describe_waveform,
    features,
)

PER_PERIOD = 36  # samples in a period that events are sought in, at least; more is averaged ...
QUIET = 50.0  # ... until the noise is so many times smaller than the swing
MOST = 1 << 17  # samples that events are sought in: thousands of periods
DESPIKED = 1 << 20  # samples; in longer records single ones hardly matter
ALIKE = 0.12  # a scatter of periods above which cycles may have been missed or split
STEPS = 1.5  # quantisation steps
_AGAIN = 200  # cycles that tell how much noise adds to them
_ROUNDS = 2


class Limits(NamedTuple):
    """What an event has to exceed, and what is looked at; see `stick_slip`."""

    hysteresis: float = 0.5
    noise_levels: float = 4.0
    fewest_samples: int = 16


DEFAULT = Limits()


class Examined(NamedTuple):
    """What a record holds; numbers carry the signal's unit."""

    oscillation: Oscillation
    events: Events
    waveform: Waveform
    hysteresis: float
    sample_noise: float
    spike_share: float
    force: bool = False


def examine(
    time: np.ndarray, values: np.ndarray, limits: Limits = DEFAULT, *, force: bool = False
) -> Examined | str:
    """Look at one record; text where there is nothing to see, saying why.

    Parameters
    ----------
    time, values
        [s], friction positive in the sense of resistance (time).
    limits
        What counts.
    force
        Whether the values are a force [N]; for the record.
    """
    record = make_record(time, values)
    n = record.values.size
    if n < max(limits.fewest_samples, 4):
        return f"{n} samples are too few"
    least = 1e-12 * abs(record.values[0])
    if np.ptp(record.values[:4096]) <= least and np.ptp(record.values) <= least:
        return "the signal is constant"
    noise, spikes = noise_level(record.values[: 1 << 17]), 0
    if n <= DESPIKED:
        kept, spikes = without_spikes(record.values, noise)
        record = record._replace(values=kept)
    found = oscillation(record)
    if found is None:
        return "too short for a spectrum"
    most = int(1 / (found.frequency * PER_PERIOD * record.spacing))
    # no more is averaged than the noise calls for: means round off what is abrupt
    wanted = min(QUIET * noise / max(found.swing, 1e-300), 1e6) ** 2
    size = int(max(1, min(most, wanted)))
    part = Record(record.time[: MOST * size], record.values[: MOST * size], *record[2:])
    view = coarse(part, size)
    step = quantisation_step(record.values[: 1 << 16])
    hysteresis = max(
        limits.hysteresis * found.swing, limits.noise_levels * noise / np.sqrt(size), STEPS * step
    )
    events = find_events(view.time, view.values, hysteresis)
    if events.drop.size:  # cycles that differ have less of a line than of a drop: look at the drops
        typical = limits.hysteresis * float(np.mean(events.drop))
        if typical > hysteresis:
            hysteresis = typical
            events = find_events(view.time, view.values, hysteresis)
    lag = max(1, int(round(1 / (found.frequency * 16 * view.spacing))))
    form = describe_waveform(view.values, lag, events)
    if events.drop.size:
        excess = _excess(part, view, found, events, form, hysteresis)
        events = events._replace(drop=events.drop - excess, rise=events.rise - excess)
    return Examined(found, events, form, hysteresis, noise, spikes / n, force)


def _excess(
    part: Record,
    view: Record,
    found: Oscillation,
    events: Events,
    form: Waveform,
    hysteresis: float,
) -> float:
    """By how much the mean of the drops, as picked from valley to peak, is too large."""
    kind = class_probabilities(features(form, found))
    if kind[0] >= 0.5:
        return 0.0
    mean = float(np.mean(events.drop))
    if form.period_scatter < ALIKE:  # the cycles lie on one another
        means = {1: abrupt_drop, 2: smooth_drop}.get(int(np.argmax(kind)))
        finer = max(1, round(view.spacing / part.spacing) // 2)  # means round off what is abrupt
        drop = means(coarse(part, finer), events) if means else np.nan
        if 0.25 * mean < drop < 1.25 * mean:
            return mean - drop
    # of a sine, its power says best how large it is: the noise's has been taken off
    sine = float(np.clip((0.35 - found.harmonic_content) / 0.2, 0.0, 1.0))
    excess = min(noise_excess(view, found, events, hysteresis), 0.5 * mean) if sine < 1 else 0.0
    return sine * (mean - found.swing) + (1 - sine) * excess


def noise_excess(record: Record, found: Oscillation, events: Events, hysteresis: float) -> float:
    """By how much the noise makes the mean drop look larger.

    Parameters
    ----------
    record
        In which the events were found.
    found
        Oscillation with its background.
    events
        Events of the record.
    hysteresis
        Smallest swing that counts.

    Returns
    -------
    float
        In the signal's unit.

    Notes
    -----
    Turning points are picked where the noise adds to them. How much that is depends on the form,
    on the noise and on how often it is sampled, so it is seen by doing it again: noise drawn from
    the background's spectrum is laid on the cycles that were found, and cycles are sought once
    more. Harmonics may have been taken for noise: what is left beside straight lines from turn to
    turn says how much there is. Noise slower than half the oscillation's frequency moves peaks and
    valleys alike and is left out.
    """
    events = Events(*(part[:_AGAIN] for part in events))  # so many tell, however long the record
    n = int(np.searchsorted(record.time, events.stop[-1])) + 1
    frequency = np.fft.rfftfreq(n, record.spacing)
    density = np.interp(frequency, found.bands, found.background)
    density[frequency < 0.5 * found.frequency] = 0.0
    height = np.sqrt(density * n / (4 * record.spacing))
    time, cycles, rest = _cycles(record.time, record.values, events)
    inside = np.searchsorted(record.time, time[0])
    rng = np.random.default_rng(0)
    for _ in range(_ROUNDS):
        drops, rests = [np.zeros(0)], []
        for _ in range(int(np.clip(_AGAIN / events.drop.size, 1, 32))):
            draw = rng.standard_normal((2, height.size))
            noise = np.fft.irfft(height * (draw[0] + 1j * draw[1]), n)
            noisy = cycles + noise[inside : inside + time.size]
            again = find_events(time, noisy, hysteresis)
            drops.append(again.drop)
            if again.drop.size:
                rests.append(_cycles(time, noisy, again)[2])
        if not sum(rests) > 0:  # no cycles are left, or no noise was laid on them
            return 0.0
        height *= min(rest * len(rests) / sum(rests), 1.0)
    return float(np.concatenate(drops).mean() - events.drop.mean())


def _cycles(
    time: np.ndarray, values: np.ndarray, events: Events
) -> tuple[np.ndarray, np.ndarray, float]:
    """Moments within the events, straight lines from turn to turn, and what is left beside them."""
    knots = np.append(np.stack([events.start, events.peak], axis=1).ravel(), events.stop[-1])
    first, last = np.searchsorted(time, knots[[0, -1]])
    time, values = time[first : last + 1], values[first : last + 1]
    lines = np.interp(time, knots, values[np.searchsorted(time, knots)])
    return time, lines, float(np.sqrt(np.mean((values - lines) ** 2)))
