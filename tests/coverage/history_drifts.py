"""Sixty campaigns on a rig whose gain drifts and whose zero jumps, and two hundred on a sound one.

Run with ``PYTHONPATH=$PWD:$PWD/tests python tests/coverage/history_drifts.py``. The gain drifts
by 0.5 % a month, the zero jumps by two standard deviations; both are wanted within the run length
that is stated for them, on average over many rigs, and false alarms of sound rigs as often as
stated.
With ``--folders N RESULTS`` the time to read and judge N copies of a results folder is wanted below
5 s for 1000. Exits with 1 where any of it is missed.
"""

import argparse
import datetime as dt
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import tribolab as tl
from tribolab.comparison.instrument_history import history_of
from tribolab.comparison.watched import Observation
from tribolab.metrology.run_length import average_run_length, signal_probability

BASELINE, SCATTER, WEEK = 20, 0.01, 7 / 30.4
RIGS = 400


def rig(rng, campaigns, drift=0.0, jump=0.0):
    """Weekly points in standard deviations: a gain that drifts and a zero that jumps."""
    points = []
    for week in range(campaigns):
        when, since = dt.datetime(2026, 1, 5) + dt.timedelta(days=7 * week), week - BASELINE + 1
        gain = rng.normal(1, SCATTER) + drift * WEEK * max(0, since)
        zero = rng.normal() + jump * (since > 0)
        points.append(Observation("rig", "gain", "1", when, str(week), gain))
        points.append(Observation("rig", "zero", "N", when, str(week), zero))
    return history_of(points, baseline=BASELINE).charts


def delays(charts):
    """Points from the change to the first signal; the whole record where there is none."""
    return [
        (chart.signals[0] + 1 if chart.signals.size else chart.values.size) - BASELINE
        for chart in charts
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--folders", type=int, default=0)
    parser.add_argument("results", nargs="?", type=Path)
    chosen = parser.parse_args()
    rng = np.random.default_rng(chosen.seed)
    fine = True

    told = np.array([delays(rig(rng, 60, drift=0.005, jump=2.0)) for _ in range(RIGS)])
    stated = (
        average_run_length(drift=0.005 * WEEK / SCATTER, baseline=BASELINE),
        average_run_length(shift=2.0, baseline=BASELINE),
    )
    for name, own, wanted in zip(("gain drifts", "zero jumps"), told.T, stated, strict=True):
        good = own.mean() <= 1.05 * wanted
        fine &= good
        print(
            f"{name}: found after {own.mean():.1f} points (median {np.median(own):.0f}), stated "
            f"{wanted:.1f}; not in 60 campaigns {np.mean(own >= 40):.1%}{'' if good else ' MISSED'}"
        )

    alarms = [c.signals.size > 0 for _ in range(RIGS) for c in rig(rng, 200)]
    wanted = signal_probability(200 - BASELINE, baseline=BASELINE)
    spread = 3 * np.sqrt(wanted * (1 - wanted) / len(alarms))
    good = abs(np.mean(alarms) - wanted) <= spread
    fine &= good
    print(
        f"200 sound campaigns: {np.mean(alarms):.1%} of charts alarm, stated {wanted:.1%} "
        f"(known limits: {signal_probability(180):.1%}){'' if good else ' MISSED'}"
    )

    if chosen.folders:
        with tempfile.TemporaryDirectory() as folder:
            for number in range(chosen.folders):
                mine = Path(folder) / f"{number:04}"
                (mine / "tables").mkdir(parents=True)
                for name in ("report.json", "tables/stick_slip.csv"):
                    shutil.copy(chosen.results / name, mine / name)
            begun, since = time.process_time(), time.perf_counter()
            tl.comparison.history(sorted(Path(folder).iterdir()))
            spent, wall = time.process_time() - begun, time.perf_counter() - since
        good = spent <= 5 * chosen.folders / 1000
        fine &= good
        late = "" if good else " MISSED"
        print(f"{chosen.folders} folders: {spent:.1f} s of processor, {wall:.1f} s{late}")
    print("as wanted" if fine else "missed")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
