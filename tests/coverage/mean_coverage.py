"""Does U95 of a record's mean hold the truth, and how wide is the standard error?

    python tests/coverage/mean_coverage.py                  (500 records a row, seed 100)
    python tests/coverage/mean_coverage.py --records 100 --seed 0
    python tests/coverage/mean_coverage.py --pieces ../shared/data

A row for each kind of signal: coverage of the 95 % interval of the mean over the path, the median
standard error over the true scatter, the share of records that are determined (U95 at most half
the range) and coverage there, and coverage beyond the path. With --pieces, measured records are cut
into 4, 8 and 16 pieces: the share of pieces whose interval beyond the path holds the mean of the
others.

The exit code says whether coverage is at least 90 % wherever a record has more than five effective
samples, and the median standard error at most 1.6 times the scatter (sawtooths excepted).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter

import tribolab as tl
from tribolab.friction.mean_error.estimates import Estimate, estimate_of, estimates_of

N = 1920
T = (np.arange(N) + 0.5) / N


def wander(rng: np.random.Generator, count: int, share: float) -> np.ndarray:
    """AR(1) of variance 1, whose memory is a share of the record, stationary from the start."""
    a = np.exp(-1 / (share * N))
    noise = rng.standard_normal((count, N)) * np.sqrt(1 - a * a)
    noise[:, 0] /= np.sqrt(1 - a * a)
    return np.asarray(lfilter([1], [1, -a], noise, axis=1))


def sine(rng: np.random.Generator, count: int, cycles: float) -> np.ndarray:
    phase = 2 * np.pi * (cycles * T + rng.random((count, 1)))
    return np.asarray(np.sin(phase) + 0.1 * rng.standard_normal((count, N)))


def saw(rng: np.random.Generator, count: int, cycles: float) -> np.ndarray:
    """A sawtooth whose periods differ by 5 %."""
    result = np.empty((count, N))
    for record in result:
        periods = (1 + 0.05 * rng.standard_normal(int(3 * cycles) + 6)) / cycles
        edges = np.cumsum(periods) - (1 + rng.random()) / cycles
        record[:] = np.interp(T, edges, np.arange(edges.size)) % 1 - 0.5
    return result + 0.02 * rng.standard_normal((count, N))


def oscillator(rng: np.random.Generator, count: int, cycles: float) -> np.ndarray:
    """AR(2) noise about a frequency, damped over three periods."""
    r, w = np.exp(-cycles / (3 * N)), 2 * np.pi * cycles / N
    noise = rng.standard_normal((count, 4 * N))
    made = lfilter([1], [1, -2 * r * np.cos(w), r * r], noise, axis=1)[:, -N:]
    return np.asarray(made / made.std())


def pink(rng: np.random.Generator, count: int, power: float) -> np.ndarray:
    """1/f noise down to an eighth of a cycle per record."""
    size = 8 * N
    f = np.fft.rfftfreq(size)
    f[0] = np.inf
    spectrum = f ** (-power / 2) * (
        rng.standard_normal((count, f.size)) + 1j * rng.standard_normal((count, f.size))
    )
    made = np.fft.irfft(spectrum, size, axis=1)
    at = rng.integers(0, size - N, count)[:, None] + np.arange(N)
    return np.asarray(np.take_along_axis(made, at, axis=1) / made.std())


def course(shape: np.ndarray) -> np.ndarray:
    """A course of the path: its mean belongs to it."""
    return np.asarray(shape - shape.mean())


class Kind(NamedTuple):
    """A kind of signal of true mean 0, its effective samples, and whether the width counts."""

    make: Callable[[np.random.Generator, int], np.ndarray]
    effective: float
    width_counts: bool = True


DRIFT, RUN_IN = course(4 * np.sqrt(12) * T), course(10 * np.exp(-T / 0.25))
KINDS: dict[str, Kind] = {
    "white": Kind(lambda r, k: r.standard_normal((k, N)), N),
    **{
        f"AR(1) T/{share}": Kind(lambda r, k, s=share: wander(r, k, 1 / s), share / 2)
        for share in (200, 50, 20, 10, 5)
    },
    "AR(2) 10 periods": Kind(lambda r, k: oscillator(r, k, 10.0), 100),
    "1/f": Kind(lambda r, k: pink(r, k, 1.0), 3),
    **{f"sine {c}": Kind(lambda r, k, c=c: sine(r, k, c), 100) for c in (1.5, 5.3, 20, 50)},
    **{f"saw {c}": Kind(lambda r, k, c=c: saw(r, k, c), 100, False) for c in (6.5, 20.3)},
    "drift 4 SD + white": Kind(lambda r, k: DRIFT + r.standard_normal((k, N)), N),
    "drift + AR(1) T/50": Kind(lambda r, k: DRIFT + wander(r, k, 1 / 50), 25),
    "run-in T/4 + white": Kind(lambda r, k: RUN_IN + r.standard_normal((k, N)), N),
    "run-in + AR(1) T/50": Kind(lambda r, k: RUN_IN + wander(r, k, 1 / 50), 25),
    "AR(1) T/20 + 3 white": Kind(
        lambda r, k: wander(r, k, 1 / 20) + 3 * r.standard_normal((k, N)), 40
    ),
}


def print_coverage(records: int, seed: int) -> bool:
    """Print a row for each kind; whether the aims are met."""
    time, met = np.arange(N) * 0.01, True
    print(f"{records} records of {N} samples, seed {seed}; all in %, but sem over true scatter")
    print(f"{'':22}{'covered':>8}{'sem':>6}{'determined':>11}{'covered':>8}{'beyond':>8}")
    for number, (name, kind) in enumerate(KINDS.items()):
        made = kind.make(np.random.default_rng([seed, number]), records)
        found = estimates_of((time, record) for record in made)
        mean, sem, wide, past = (
            np.array([getattr(one, part) for one in found])
            for part in ("mean", "sem", "u95", "u95_beyond")
        )
        sure = np.array([one.determined for one in found])
        inside, ratio = np.abs(mean) <= wide, np.median(sem) / np.sqrt(np.mean(mean**2))
        there = f"{100 * inside[sure].mean():8.0f}" if sure.any() else f"{'-':>8}"
        print(
            f"{name:22}{100 * inside.mean():8.1f}{ratio:6.2f}{100 * sure.mean():11.0f}{there}"
            f"{100 * np.mean(np.abs(mean) <= past):8.1f}"
        )
        if kind.effective > 5:
            met &= bool(inside.mean() >= 0.90) and (ratio <= 1.6 or not kind.width_counts)
    return met


def measured_records(folder: Path) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Friction of the longest segment of every measured run of a folder: name, time, values."""
    for path in sorted(folder.glob("*/*")):
        if path.parent.name == "cases" or path.suffix.lower() not in (
            ".txt",
            ".tsv",
            ".csv",
            ".mat",
        ):
            continue
        try:
            run = tl.read(path)
            segments = tl.find_segments(run, trim="10 %")
        except tl.TribolabError:
            continue
        names = [n for n in ("friction_coefficient", "friction_force") if n in run]
        if not names or not segments.sizes["segment"]:
            continue
        spans = segments["trimmed_stop"] - segments["trimmed_start"]
        k = int(np.argmax(spans.values))
        inside = (run["time"] >= segments["trimmed_start"][k]) & (
            run["time"] <= segments["trimmed_stop"][k]
        )
        values = run[names[0]].values[inside.values]
        fine = np.isfinite(values)
        if fine.sum() >= 480:
            yield path.name, run["time"].values[inside.values][fine], values[fine]


def print_pieces(folder: Path) -> None:
    """Print how often the interval of a piece holds the mean of the other pieces."""
    counts: dict[int, list[bool]] = {4: [], 8: [], 16: []}
    print(f"{'':36}{'4':>6}{'8':>6}{'16':>6}   pieces; share whose interval holds the others' mean")
    for name, time, values in measured_records(folder):
        row = []
        for pieces, held in counts.items():
            cut = [
                estimate_of(t, v)
                for t, v in zip(
                    np.array_split(time, pieces), np.array_split(values, pieces), strict=True
                )
            ]
            own = [_holds(cut, k) for k in range(pieces)]
            held += own
            row.append(f"{100 * np.mean(own):6.0f}")
        print(f"{name[:35]:36}{''.join(row)}")
    print(f"{'all':36}{''.join(f'{100 * np.mean(held):6.0f}' for held in counts.values())}")


def _holds(cut: list[Estimate], k: int) -> bool:
    others = np.mean([one.mean for n, one in enumerate(cut) if n != k])
    wide = getattr(cut[k], "u95_beyond", np.nan)
    if not np.isfinite(wide):
        wide = 1.96 * cut[k].sem
    return bool(abs(cut[k].mean - others) <= wide)


def main() -> int:
    """Print what was asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--records", type=int, default=500)
    parser.add_argument("--seed", type=int, default=100)
    parser.add_argument("--pieces", type=Path)
    chosen = parser.parse_args()
    if chosen.pieces is not None:
        print_pieces(chosen.pieces)
        return 0
    return 0 if print_coverage(chosen.records, chosen.seed) else 1


if __name__ == "__main__":
    sys.exit(main())
