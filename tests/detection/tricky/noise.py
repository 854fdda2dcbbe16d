"""Noise as sensors have it: white, red, hum, spikes, digits of a converter."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter


def red(rng: np.random.Generator, n: int, rate: float, correlation: float) -> np.ndarray:
    """Noise of rms 1 that forgets itself within `correlation` [s] (an Ornstein-Uhlenbeck walk)."""
    keep = np.exp(-1.0 / (rate * correlation))
    kicks = rng.standard_normal(n) * np.sqrt(1 - keep**2)
    kicks[0] = rng.standard_normal()
    return lfilter([1.0], [1.0, -keep], kicks)


def noise(
    rng: np.random.Generator, n: int, rate: float, rms: float, kind: str = "white"
) -> np.ndarray:
    """Noise of one kind with the given rms."""
    white = rng.standard_normal(n)
    if kind == "white":
        return rms * white
    if kind == "red":
        return rms * (0.6 * white + 0.8 * red(rng, n, rate, 20.0 / rate))
    if kind == "hum":
        line = rng.choice([50.0, 60.0])
        wave = np.sqrt(2) * np.sin(2 * np.pi * line * np.arange(n) / rate + rng.uniform(0, 6.28))
        return rms * (0.9 * white + 0.3 * wave)
    if kind == "spikes":
        hit = rng.random(n) < 2e-4
        return rms * (white + hit * rng.choice([-1, 1], n) * rng.uniform(10, 30, n))
    if kind == "quantised":
        digit = rms
        return np.round(rms * white / digit) * digit
    raise ValueError(kind)


USUAL = ("white", "white", "red", "quantised", "hum")  # spikes are a kind of run of their own
