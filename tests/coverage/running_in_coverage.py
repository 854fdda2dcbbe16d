"""How often running-in is found, where it ends and how well the steady value is known.

    python tests/coverage/running_in_coverage.py [records]

Level 30 standard deviations, as in statistics of friction strokes (mu 0.3 +- 0.01).
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.signal import lfilter

from tribolab.friction.mean_error.level import levels_of
from tribolab.friction.running_in.settling import blocks_of, settling_of

LEVEL = 30.0


def noise(rng, n, memory=0.0):
    """White noise of variance 1, or with a memory of `memory` of the record."""
    if not memory:
        return rng.standard_normal(n)
    phi = np.exp(-1 / (memory * n))
    raw = rng.standard_normal(n + int(10 * memory * n))
    return lfilter([np.sqrt(1 - phi**2)], [1, -phi], raw)[-n:]


def cases():
    """Name, memory of the noise, course over t and rng."""
    yield "white", 0, lambda t, r: 0 * t
    yield "memory T/100", 0.01, lambda t, r: 0 * t
    yield "memory T/20", 0.05, lambda t, r: 0 * t
    yield "sine 5.3, 2 SD", 0, lambda t, r: 2 * np.sin(2 * np.pi * (5.3 * t + r.random()))
    yield "drift 4 SD", 0, lambda t, r: 4 * t
    yield "step 3 SD at .3", 0, lambda t, r: -3.0 * (t > 0.3)
    for size in (2, 5):
        for c in (0.02, 0.1, 0.25):
            yield f"{size} SD, c {c}", 0, lambda t, r, s=size, c=c: s * np.exp(-t / c)
    yield "5 SD, c .1, memory T/100", 0.01, lambda t, r: 5 * np.exp(-t / 0.1)
    yield "5 SD, c .6", 0, lambda t, r: 5 * np.exp(-t / 0.6)
    yield (
        "rise 5 SD, c .02, fall 5 SD, c .1",
        0,
        lambda t, r: 5 * np.exp(-t / 0.1) - 8 * np.exp(-t / 0.02),
    )
    yield "power law", 0, lambda t, r: 5 / (1 + t / 0.03)
    yield (
        "5 SD, c .05, then rise 5 SD at .85",
        0,
        lambda t, r: 5 * np.exp(-t / 0.05) + 5 * (t > 0.85) * (1 - np.exp(-(t - 0.85) / 0.05)),
    )


def measured(name, memory, course, n, records, seed=8):
    """Return the kinds, the starts and stops over n, and the steady value's coverage."""
    rng = np.random.default_rng(seed)
    t = np.arange(n) / n
    kinds, starts, stops, inside = [], [], [], []
    for _ in range(records):
        own = course(t, rng)
        y = LEVEL + own + noise(rng, n, memory)
        found = settling_of(y)
        kinds.append(found.kind)
        if found.is_steady:
            starts.append(found.start / n)
            stops.append(found.stop / n)
            part = slice(found.start, found.stop)
            level = levels_of(blocks_of(y[part], 384)[None])
            inside.append(abs(y[part].mean() - LEVEL - own[part].mean()) < level.u95[0])
    return np.array(kinds), np.array(starts), np.array(stops), np.array(inside)


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 120
    for n in (1000, 100):
        print(
            f"\n{n} values\n{'case':36s} none run-in unfinished step | start  IQR   stop | covered"
        )
        for name, memory, course in cases():
            kinds, starts, stops, inside = measured(name, memory, course, n, count)
            share = [
                100 * np.mean(kinds == kind)
                for kind in ("none", "running-in", "not finished", "step")
            ]
            where = np.quantile(starts, [0.5, 0.25, 0.75]) if starts.size else np.full(3, np.nan)
            stop = np.median(stops) if stops.size else np.nan
            print(
                f"{name:36s}"
                + " ".join(f"{each:6.0f}" for each in share)
                + f" | {where[0]:.3f} {where[2] - where[1]:.3f} {stop:.3f} | "
                + (f"{100 * inside.mean():.0f} %" if inside.size else "-"),
                flush=True,
            )
