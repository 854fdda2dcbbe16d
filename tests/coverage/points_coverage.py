"""Points of curves: which speeds are one, do means of few repeats cover, are odd repeats found?

    python tests/coverage/points_coverage.py                    (all three tables)
    python tests/coverage/points_coverage.py means --runs 4000 --seed 104

groups   share of campaigns whose speeds are grouped wrongly, by kind, scatter and speeds a decade;
         in brackets those of them that are called clear
means    lowest coverage of U95 over ratios of the errors and scatters between runs, and the median
         half width over the ideal one, without and with what is known from other conditions
odd      false alarms per campaign, and how often one run that is off is found
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from tribolab.friction.points.mean_of_repeats import Pooled, mean_of_repeats
from tribolab.friction.points.odd_repeats import odd_repeats
from tribolab.friction.points.speed_groups import speed_groups, sweeps_of


def campaign(
    rng: np.random.Generator, per_decade: int, runs: int, scatter: float, kind: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Make speeds with the number of their true point, their run and their place in it."""
    base = np.linspace(0, 3 * np.log(10), 3 * per_decade + 1)
    speed, label, run, place = [], [], [], []
    for number in range(runs):
        kept = rng.random(base.size) > 0.2 if runs > 1 else np.ones(base.size, bool)
        offset = 0.5 * scatter * rng.standard_normal() if kind == "offset" else 0.0
        for _ in range(2 if kind == "updown" else 1):
            x = base[kept] + scatter * rng.standard_normal(kept.sum()) + offset
            speed.append(x)
            label.append(np.flatnonzero(kept))
            run.append(np.full(x.size, number))
            place.append(np.arange(x.size) + 1000 * len(place))
    x, labels, of, at = (np.concatenate(part) for part in (speed, label, run, place))
    return np.exp(x), labels, of, at


def print_groups(campaigns: int, seed: int) -> None:
    """Print the share of campaigns that are grouped wrongly."""
    rng, densities = np.random.default_rng(seed), (2, 5, 10, 20, 50)
    print("speeds into points: wrong % (of these called clear)")
    print(f"{'kind':10}{'scatter':>8}" + "".join(f"{d:>7}/dec" for d in densities))
    for kind, runs in (("single", 3), ("updown", 3), ("offset", 3), ("single", 8)):
        for scatter in (0.001, 0.005, 0.01, 0.02):
            row = []
            for density in densities:
                wrong = clear = 0
                for _ in range(campaigns):
                    speed, label, run, place = campaign(rng, density, runs, scatter, kind)
                    found = speed_groups(speed, 0.1, sweeps_of(run, place, speed))
                    bad = not same(found.group, label)
                    wrong += bad
                    clear += bad and found.verdict == "clear"
                row.append(f"{100 * wrong / campaigns:5.0f} ({100 * clear / campaigns:2.0f})")
            print(f"{kind + ' ' + str(runs):10}{100 * scatter:6.1f} %" + " ".join(row))


def same(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two groupings put the same observations together."""
    pairs = {tuple(pair) for pair in np.stack([one, other], axis=1).tolist()}
    return len(pairs) == len(set(one.tolist())) == len(set(other.tolist()))


def print_means(runs: int, seed: int) -> None:
    """Print lowest coverage and median width of U95 of means."""
    rng = np.random.default_rng(seed)
    print(f"means of k repeats, {runs} each: lowest coverage %, median width over the ideal")
    for title, known in (("nothing known", 0), ("known from others, 8 dof", 8)):
        for k in (2, 3, 5, 10):
            lowest, widths = 100.0, []
            for ratio in (1.0, 4.0, 30.0):
                for tau in (0.0, 0.5, 2.0, 10.0):
                    if known and tau == 0:
                        continue
                    s = np.geomspace(1.0, ratio, k) * 1e-3
                    between = tau * np.exp(np.log(s).mean())
                    ideal = 1.96 / np.sqrt((1 / (s**2 + between**2)).sum())
                    inside = 0
                    for _ in range(runs // 12):
                        y = 1 + between * rng.standard_normal(k) + s * rng.standard_normal(k)
                        scatter = between * np.sqrt(rng.chisquare(8) / 8) if known else 0.0
                        found = mean_of_repeats(y, s, Pooled(scatter, known) if known else None)
                        inside += abs(found.mean - 1) <= found.u95
                        widths.append(found.u95 / ideal)
                    lowest = min(lowest, 100 * inside / (runs // 12))
            print(f"{title:26} k = {k:2}: {lowest:5.1f}  {np.median(widths):5.2f}")


def print_odd(campaigns: int, seed: int) -> None:
    """Print false alarms per campaign and the share of odd runs that are found."""
    rng = np.random.default_rng(seed)
    offsets = (5, 8, 12, 16)
    print("odd repeats: false % a campaign (odd, suspect); found % of one run off by x SD")
    print(f"{'':12}{'odd':>6}{'suspect':>9}" + "".join(f"{x:>6}" for x in offsets))
    for title, ks in (("4 x k=2", (2,) * 4), ("8 x k=2", (2,) * 8), ("20 x k=2", (2,) * 20),
                      ("8 x k=3", (3,) * 8)):  # fmt: skip

        def made(ks: tuple[int, ...] = ks) -> list[np.ndarray]:
            return [0.01 * np.exp(0.3 * rng.standard_normal()) * rng.standard_normal(k) for k in ks]

        alarms = [odd_repeats(made()) for _ in range(campaigns)]
        odd = 100 * np.mean([any(one.odd for one in found) for found in alarms])
        suspect = 100 * np.mean([bool(found) for found in alarms])
        row = []
        for x in offsets:
            hits = 0
            for _ in range(campaigns // 4):
                groups = made()
                groups[0][0] += 0.01 * x
                hits += any(one.condition == 0 and one.odd for one in odd_repeats(groups))
            row.append(f"{100 * hits / (campaigns // 4):6.0f}")
        print(f"{title:12}{odd:6.1f}{suspect:9.1f}" + "".join(row))


def main() -> int:
    """Print the tables that were asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("table", nargs="?", choices=("groups", "means", "odd"))
    parser.add_argument("--runs", type=int, default=2400)
    parser.add_argument("--seed", type=int)
    chosen = parser.parse_args()
    if chosen.table in (None, "groups"):
        print_groups(chosen.runs // 40, chosen.seed or 101)
    if chosen.table in (None, "means"):
        print_means(chosen.runs, chosen.seed or 104)
    if chosen.table in (None, "odd"):
        print_odd(chosen.runs // 4, chosen.seed or 105)
    return 0


if __name__ == "__main__":
    sys.exit(main())
