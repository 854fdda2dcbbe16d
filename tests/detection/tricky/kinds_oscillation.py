"""Tricky oscillations: few periods, saws, two lines, a wobbling load, red noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.signal import sawtooth

from tricky import noise
from tricky.lab import draw_lab, draw_law, record
from tricky.motion import rest, strokes
from tricky.trial import Trial, tricky


def _saw(rng, amplitude, period, fall=0.1):
    """A relative saw tooth of rms amplitude that rises slowly and drops; its long mean is zero."""
    phase = rng.uniform(0, 1)
    return lambda t: np.sqrt(3) * amplitude * sawtooth(2 * np.pi * (t / period + phase), 1 - fall)


def _run(rng, lab, duration, speeds=(1.0,), samples=(800, 3000), both=None, **more):
    """An ordinary run around the oscillation: unloaded rest, then one way or both ways."""
    both = bool(rng.integers(2)) if both is None else both
    legs = [rest(10.0, 0.0), rest(3.0)]
    legs += strokes(lab.speed * np.asarray(speeds), duration, 1.0, (1, -1) if both else (1,))
    legs += [rest(3.0), rest(10.0, 0.0)]
    return record(
        rng,
        lab,
        legs,
        draw_law(rng, lab),
        rate=rng.uniform(*samples) / duration,
        offset=rng.uniform(-0.4, 0.4),
        **more,
    )


@tricky("16")
def few_periods_saw(rng) -> Trial:
    """Stick-slip with two to six periods in each stroke."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 60)
    period = duration / rng.uniform(2, 6)
    wave = _saw(rng, rng.uniform(0.05, 0.3), period, rng.uniform(0.03, 0.2))
    made = _run(rng, lab, duration, (1.0, 1.7), fluctuation=wave)
    return Trial(made.dataset(), made.truth)


@tricky("16")
def few_periods_sine(rng) -> Trial:
    """A slow wave with one and a half to six periods in each stroke."""
    lab = draw_lab(rng)
    duration = rng.uniform(10, 60)
    period = duration / rng.uniform(1.5, 6)
    size, phase = rng.uniform(0.03, 0.2), rng.uniform(0, 6.28)
    made = _run(
        rng, lab, duration, fluctuation=lambda t: size * np.sin(2 * np.pi * t / period + phase)
    )
    return Trial(made.dataset(), made.truth)


@tricky("15")
def irregular_saw(rng) -> Trial:
    """Stick-slip whose periods scatter by 30 to 60 %, with sharp drops."""
    lab = draw_lab(rng)
    duration = rng.uniform(20, 100)
    period, scatter = duration / rng.uniform(8, 40), rng.uniform(0.3, 0.6)
    size = rng.uniform(0.05, 0.4)
    shape = 1 / scatter**2

    def wave(t):
        local = np.random.default_rng(int(1e6 * period) % 2**31)
        gaps = local.gamma(shape, period / shape, int(2 * t[-1] / period) + 50)
        drops = np.cumsum(gaps) - gaps[0]
        at = np.searchsorted(drops, t, "right") - 1
        rise = (t - drops[at]) / period  # rises at one rate, falls to the same floor
        floor = 0.5 * (gaps**2).mean() / gaps.mean() / period
        return size * (rise - floor)

    made = _run(rng, lab, duration, fluctuation=wave)
    return Trial(made.dataset(), made.truth)


@tricky("17")
def red_noise(rng) -> Trial:
    """Friction wanders with a memory of seconds, three times as strong as the white noise."""
    lab = replace(draw_lab(rng), kind="white")
    duration = rng.uniform(30, 150)
    memory = duration * rng.uniform(0.02, 0.15)
    rate = rng.uniform(1000, 4000) / duration
    size = 3 * lab.noise

    def wave(t):
        return size * noise.red(rng, t.size, rate, memory)

    legs = [rest(10.0, 0.0), rest(3.0)]
    legs += strokes([lab.speed, 2 * lab.speed], duration, 1.0, (1, -1) if rng.integers(2) else (1,))
    legs += [rest(10.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rate, fluctuation=wave)
    return Trial(made.dataset(), made.truth)


@tricky("17")
def two_lines(rng) -> Trial:
    """A turn of the disc and stick-slip at once, neither a multiple of the other."""
    lab = draw_lab(rng, speed=(1e-3, 0.5))
    duration = rng.uniform(20, 80)
    slow, fast = duration / rng.uniform(3, 12), duration / rng.uniform(40, 90)
    size, phase = rng.uniform(0.02, 0.15), rng.uniform(0, 6.28)
    saw = _saw(rng, rng.uniform(0.02, 0.1), fast)
    made = _run(
        rng,
        lab,
        duration,
        (1.0, 1.4),
        (2000, 4000),
        fluctuation=lambda t: size * np.sin(2 * np.pi * t / slow + phase) + saw(t),
    )
    return Trial(made.dataset(), made.truth)


@tricky("14")
def wobbling_load(rng) -> Trial:
    """The load drifts and wobbles by some per cent; the coefficient does not."""
    lab = draw_lab(rng)
    duration = rng.uniform(15, 80)
    size, phase = rng.uniform(0.01, 0.08), rng.uniform(0, 6.28)
    period = duration / rng.uniform(0.3, 5)
    made = _run(
        rng,
        lab,
        duration,
        (1.0, 2.0),
        load_wave=lambda t: size * np.sin(2 * np.pi * t / period + phase),
    )
    return Trial(made.dataset(), made.truth)


@tricky("15")
def reversed_saw(rng) -> Trial:
    """Force falls slowly and rises sharply: the sensor hangs on the other body."""
    lab = draw_lab(rng)
    duration = rng.uniform(20, 80)
    wave = _saw(rng, rng.uniform(0.05, 0.2), duration / rng.uniform(8, 40), 0.05)
    made = _run(rng, lab, duration, fluctuation=lambda t: -wave(t))
    return Trial(made.dataset(), made.truth)


@tricky("15")
def intermittent(rng) -> Trial:
    """Stick-slip comes and goes within a stroke, in bursts of whole periods."""
    lab = draw_lab(rng)
    duration = rng.uniform(30, 120)
    size, period = rng.uniform(0.1, 0.3), duration / rng.uniform(40, 80)
    spell = int(rng.integers(8, 25))  # periods from burst to burst, and in a burst
    lasts = int(rng.uniform(0.3, 0.7) * spell)

    def burst(t):
        phase = t / period
        return size * sawtooth(2 * np.pi * phase, 0.9) * ((phase % spell) < lasts)

    made = _run(rng, lab, duration, (1.0,), (2000, 5000), fluctuation=burst)
    return Trial(made.dataset(), made.truth)


@tricky("16")
def fast_wave_slow_logger(rng) -> Trial:
    """Stick-slip with two to six samples per period."""
    lab = draw_lab(rng)
    duration = rng.uniform(30, 100)
    rate = rng.uniform(400, 1500) / duration
    wave = _saw(rng, rng.uniform(0.05, 0.3), rng.uniform(2.1, 6) / rate)
    legs = [rest(10.0, 0.0), rest(3.0), *strokes([lab.speed], duration, 1.0), rest(10.0, 0.0)]
    made = record(rng, lab, legs, draw_law(rng, lab), rate=rate, fluctuation=wave)
    return Trial(made.dataset(), made.truth)
