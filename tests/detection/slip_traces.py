"""Tricky traces of friction whose truth is known: drawn apart from the virtual rig's own waves.

Time in seconds, sliding speed 1 (so that a wavelength is a period), friction about 1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import signal

from tribolab.friction.oscillation.slip_segments import stick_slip

RATE = 50.0  # Hz
FALL = {"sawtooth": 0.06, "reversed": 0.94}


class Tricky(NamedTuple):
    """A trace and its truth; NaN where there is none.

    Parameters
    ----------
    values
        Friction (time), sampled with `rate`.
    rate
        [Hz]
    form
        "none", "sawtooth", "reversed" or "rounded".
    period
        Mean time from drop to drop [s].
    share
        Part of the time that oscillates.
    lines
        Frequencies [Hz], the strongest first.
    """

    values: np.ndarray
    rate: float
    form: str
    period: float = np.nan
    share: float = 1.0
    lines: tuple[float, ...] = ()


def wave(form: str, turns: np.ndarray) -> np.ndarray:
    """One wave of height 1 at phases [turns]."""
    phase = turns % 1.0
    if form == "rounded":
        return 0.5 * (np.sin(2 * np.pi * phase) - 0.08 * np.sin(4 * np.pi * phase))
    fall = FALL[form]
    rising = phase / (1 - fall)
    return np.where(phase < 1 - fall, rising, (1 - phase) / fall) - 0.5


def phases(
    rng: np.random.Generator, time: np.ndarray, period: float, scatter: float
) -> tuple[np.ndarray, np.ndarray]:
    """Phase [turns] of a wave whose periods scatter, and where each turn begins [s]."""
    count = int(3 * (time[-1] + period) / period) + 30
    shape = 1 / max(scatter, 1e-3) ** 2
    drawn = rng.gamma(shape, 1 / shape, count)  # of mean one; a period is never negative
    if rng.uniform() < 0.5:
        drawn = np.clip(1 + scatter * rng.standard_normal(count), 0.2, None)
    edges = np.concatenate([[0.0], np.cumsum(period * drawn)]) - rng.uniform(1, 2) * period
    return np.interp(time, edges, np.arange(edges.size)), edges


def red(rng: np.random.Generator, n: int, step: float, correlation: float) -> np.ndarray:
    """AR(1) noise of standard deviation one."""
    a = np.exp(-step / correlation)
    start = [a * rng.standard_normal()]
    drive = np.sqrt(1 - a * a) * rng.standard_normal(n)
    return signal.lfilter([1.0], [1.0, -a], drive, zi=start)[0]


def flicker(rng: np.random.Generator, n: int, power: float = 1.0) -> np.ndarray:
    """Noise whose spectrum falls with a power of frequency, of standard deviation one."""
    f = np.fft.rfftfreq(2 * n)
    draw = rng.standard_normal((2, f.size))
    size = np.concatenate([[0.0], f[1:] ** (-power / 2)])
    values = np.fft.irfft(size * (draw[0] + 1j * draw[1]))[:n]
    return (values - values.mean()) / values.std()


def few(rng, periods: float, form: str, drop: float = 0.2) -> Tricky:
    """Few periods in a stroke, amplitude 4 to 20 times the noise."""
    n = int(rng.integers(800, 4000))
    time = np.arange(n) / RATE
    period = time[-1] / periods
    turns, edges = phases(rng, time, period, rng.choice([0.0, 0.03, 0.07]))
    values = 1 + drop * wave(form, turns) + _noise(rng, n, 0.5 * drop / rng.uniform(4, 20))
    return Tricky(values, RATE, form, _mean_period(edges, time))


def _mean_period(edges: np.ndarray, time: np.ndarray) -> float:
    """Mean of the periods that lie within the record for the most part."""
    inside = (edges[1:] > time[0]) & (edges[:-1] < time[-1])
    return float(np.diff(edges)[inside].mean())


def _noise(rng, n: int, size: float) -> np.ndarray:
    slow = red(rng, n, 1 / RATE, 0.01 * n / RATE)
    return size * (np.sqrt(0.5) * slow + np.sqrt(0.5) * rng.standard_normal(n))


def scattered(rng, scatter: float, form: str = "sawtooth", drop: float = 0.2) -> Tricky:
    """Periods that scatter, 25 to 80 of them; drops alike."""
    time = np.arange(int(rng.integers(3000, 8000))) / RATE
    period = time[-1] / rng.uniform(25, 80)
    turns, edges = phases(rng, time, period, scatter)
    values = 1 + drop * wave(form, turns)
    values += _noise(rng, time.size, 0.5 * drop / rng.uniform(4, 20))
    falls = edges[(edges > 0) & (edges < time[-1])]
    return Tricky(values, RATE, form, float(np.diff(falls).mean()))


def plain(rng, form: str, drop: float = 0.2) -> Tricky:
    """Nearly alike periods, 8 to 80 of them."""
    time = np.arange(int(rng.integers(2000, 8000))) / RATE
    period = time[-1] / rng.uniform(8, 60)
    turns, edges = phases(rng, time, period, 0.07)
    values = 1 + drop * wave(form, turns)
    values += _noise(rng, time.size, 0.5 * drop / rng.uniform(3, 20))
    falls = edges[(edges > 0) & (edges < time[-1])]
    return Tricky(values, RATE, form, float(np.diff(falls).mean()))


def intermittent(rng, share: float, form: str, drop: float = 0.2) -> Tricky:
    """Trains of whole cycles with quiet between them; 3 to 7 trains of 6 cycles or more."""
    trains = int(rng.integers(3, 8))
    cycles = rng.integers(6, 20, trains)
    period = float(rng.uniform(0.6, 2.0))
    quiet_total = cycles.sum() * period * (1 - share) / share
    quiet = quiet_total * rng.dirichlet(np.full(trains, 4.0))
    spans, turns = [], []
    for count, pause in zip(cycles, quiet, strict=True):
        lengths = period * (1 + 0.05 * rng.standard_normal(count))
        spans += [pause, *lengths]
        turns += [0.0, *np.ones(count)]
    edges = np.concatenate([[0.0], np.cumsum(spans)])
    time = np.arange(0, edges[-1] - 1 / RATE, 1 / RATE)
    phase = np.interp(time, edges, np.concatenate([[0.0], np.cumsum(turns)]))
    shape = wave(form, phase) - wave(form, np.zeros(1))
    values = 1 + drop * shape + _noise(rng, time.size, 0.5 * drop / rng.uniform(5, 20))
    return Tricky(values, RATE, form, period, share)


def two_lines(rng, drop: float = 0.2) -> Tricky:
    """Two sines, the second 30 to 80 % as large, at no simple ratio of frequencies."""
    time = np.arange(int(rng.integers(3000, 8000))) / RATE
    first = rng.uniform(20, 60) / time[-1]
    ratio = rng.choice([1.37, 1.62, 2.3, 2.7, 3.4, 0.62, 0.43])
    size = rng.uniform(0.3, 0.8)
    values = 1 + _noise(rng, time.size, 0.5 * drop / rng.uniform(4, 20))
    for f, part in ((first, 1.0), (first * ratio, size)):
        values += 0.5 * drop * part * np.sin(2 * np.pi * (f * time + rng.uniform()))
    return Tricky(values, RATE, "rounded", 1 / first, lines=(first, first * ratio))


def in_red_noise(rng, form: str, drop: float = 0.2, correlation: float = 5.0) -> Tricky:
    """Red noise three times the white noise in rms; a strong saw has drops 4 to 12 times white."""
    time = np.arange(int(rng.integers(3000, 10_000))) / RATE
    white = drop / rng.uniform(4, 12)
    values = 1 + white * rng.standard_normal(time.size)
    values += 3 * white * red(rng, time.size, 1 / RATE, correlation)
    if form == "none":
        return Tricky(values, RATE, "none")
    period = float(rng.uniform(0.5, 3.0))
    turns, edges = phases(rng, time, period, 0.05)
    falls = edges[(edges > 0) & (edges < time[-1])]
    return Tricky(values + drop * wave(form, turns), RATE, form, float(np.diff(falls).mean()))


def quiet(rng, kind: str) -> Tricky:
    """Nothing that oscillates: white, red, 1/f or slower noise, or a drift in noise."""
    n = int(np.exp(rng.uniform(np.log(300), np.log(12_000))))
    time = np.arange(n) / RATE
    place = np.linspace(0, 1, n)
    white = 0.01 * rng.standard_normal(n)
    size = 0.01 * 10 ** rng.uniform(-0.5, 1)
    if kind == "white":
        values = white
    elif kind == "red":
        values = white + size * red(rng, n, 1 / RATE, time[-1] * 10 ** rng.uniform(-3, 0))
    elif kind == "red, 5 s":
        values = white + 0.03 * red(rng, n, 1 / RATE, 5.0)
    elif kind == "1/f":
        values = 0.1 * white + size * flicker(rng, n, rng.uniform(0.7, 1.3))
    elif kind == "1/f2":
        values = white + size * flicker(rng, n, 2.0)
    else:
        bend = rng.choice(["line", "run-in", "parabola", "hump", "step"])
        drift = {
            "line": place,
            "run-in": np.exp(-place / rng.uniform(0.05, 0.5)),
            "parabola": (place - rng.uniform(0.2, 0.8)) ** 2,
            "hump": np.sin(np.pi * rng.uniform(0.5, 1.5) * place + rng.uniform(0, 6)),
            "step": np.tanh((place - rng.uniform(0.2, 0.8)) / 0.05),
        }[bend]
        values = white + 10 * size * rng.choice([-1, 1]) * drift
    return Tricky(1 + values, RATE, "none")


def look(trace: Tricky) -> xr.Dataset:
    """Return what is seen in a trace."""
    time = np.arange(trace.values.size) / trace.rate
    ends = {"start": 0, "trimmed_start": 0, "stop": -1, "trimmed_stop": -1}
    run = xr.Dataset({"friction_coefficient": ("time", trace.values)}, {"time": time})
    data = {name: ("segment", time[[at]]) for name, at in ends.items()}
    data |= {"sliding_speed": ("segment", [1.0]), "direction": ("segment", np.int8([1]))}
    return stick_slip(run, xr.Dataset(data, {"segment": [0]})).isel(segment=0)
