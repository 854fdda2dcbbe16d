"""One record seen whole: oscillation, events and form at the scale of its own period."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.events import Events, find_events, without_spikes
from tribolab.friction.noise import noise_level, quantisation_step
from tribolab.friction.oscillation import Oscillation, oscillation
from tribolab.friction.spectra import Record, coarse, make_record
from tribolab.friction.waveform import Waveform, describe_waveform

PER_PERIOD = 48  # samples in a period that events are sought in, at least; more is averaged ...
QUIET = 50.0  # ... until the noise is so many times smaller than the swing
MOST = 1 << 17  # samples that events are sought in: thousands of periods
DESPIKED = 1 << 20  # samples; in longer records single ones hardly matter
STEPS = 1.5  # quantisation steps


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
    if np.ptp(record.values) <= 1e-12 * abs(record.values[0]):
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
    lag = max(1, int(round(1 / (found.frequency * 16 * view.spacing))))
    form = describe_waveform(view.values, lag, events)
    if events.drop.size:
        excess = noise_excess(found, form.fall_share, 0.5 / view.spacing)
        # of a sine, its power says best how large it is: the noise's has been taken off
        sine = float(np.clip((0.35 - found.harmonic_content) / 0.2, 0.0, 1.0))
        mean = float(np.mean(events.drop))
        excess = sine * (mean - found.swing) + (1 - sine) * min(excess, 0.5 * mean)
        events = events._replace(drop=events.drop - excess, rise=events.rise - excess)
    return Examined(found, events, form, hysteresis, noise, spikes / n, force)


def noise_excess(found: Oscillation, fall_share: float, highest: float) -> float:
    """By how much the noise makes a swing look larger, from turn to turn.

    Parameters
    ----------
    found
        Oscillation with its background.
    fall_share
        Part of a cycle that falls.
    highest
        Highest frequency that is left in the record [Hz].

    Notes
    -----
    Turning points are picked where the noise adds to them: the more so, the rounder the wave. On
    traces of the virtual rig the excess is (4.5 fall_share - 0.15) times the noise from half the
    oscillation's frequency on, within 0.5 of the noise.
    """
    f = found.bands
    part = (f > 0.5 * found.frequency) & (f < highest)
    if part.sum() < 2:
        return 0.0
    noise = float(np.sqrt(np.trapezoid(found.background[part], f[part])))
    return max(4.5 * fall_share - 0.15, 0.0) * noise
