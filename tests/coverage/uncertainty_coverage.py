"""How often U95 of a friction coefficient holds the truth, over many campaigns of the virtual rig.

Each campaign draws its calibration anew: gains, cross-talk and linearity once, the tilt for every
mount, the zeros for every run, each with the standard uncertainty that is stated to the budget.
Its runs repeat with 1 % and are mounted anew. Segments are held against the friction of their own
run, points of a curve against that of the law; a single run says nothing of repeats, so that its
points are held against its own friction. One direction: forward strokes alone, the zero as stated.
Reversal: half loops. Both should hold the truth in 93 to 97 %, with 1, 2 and 5 repeats.

All values of a campaign share its gains, cross-talk and linearity, and all points of a curve the
levels and the tilts of its runs, so that 500 campaigns are 500 draws of them and no more: drawn at
random, the coverage would err by 1 % (standard deviation), and one study in twenty would miss the
range by chance. They are scrambled Sobol points instead, which have the same distribution and half
the error; the rest of the chance is drawn at random.

Signals go from the rig to the analysis in memory; those of the first campaigns are written and read
as raw files besides, and have to give the same coefficients.

Run from the project's root::

    python tests/coverage/uncertainty_coverage.py [campaigns] [first seed] [with files]

Prints a table and a verdict; exit code 1 if it is missed.
"""

from __future__ import annotations

import dataclasses
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special
from scipy.stats import qmc

import tribolab as tl
from tribolab.rig import (
    Calibration,
    ForceCell,
    Protocol,
    Rig,
    Scatter,
    StickSlip,
    friction_law,
    simulate_run,
    write_run,
)
from tribolab.units.stamping import stamp

LOAD, REPEATS, SPEEDS = 31.0, (1, 2, 5), (3e-5, 3e-4, 3e-3)
ZERO, DRIFT, STEP = 0.04, 0.02, 0.002  # N
CELL = ForceCell(offset_friction=ZERO, offset_normal=ZERO, drift=DRIFT, step=STEP, hum=0.0)
RIG = Rig(Protocol(SPEEDS, stroke=0.15e-3), Scatter(repeat=0.0), force_cell=CELL)
LAW = friction_law("Sb-S", "glycerol", LOAD)
NO_SLIP = StickSlip()
SHARED = {
    "friction_gain": 0.008,
    "normal_gain": 0.006,
    "cross_talk_friction_from_normal": 0.003,
    "cross_talk_normal_from_friction": 0.003,
    "friction_linearity": 0.06,
    "normal_linearity": 0.06,
}
TILT = np.radians(0.4)
LEVEL = 0.01  # of a run, relative
UNITS = {"tilt": "rad", "friction_zero": "N", "normal_zero": "N", "resolution": "N"}
UNITS |= {"friction_linearity": "N", "normal_linearity": "N"}
WITHIN = (0.93, 0.97)


def stated() -> dict[str, dict[str, str]]:
    """What is stated of the calibration: the standard uncertainties that it is drawn with."""
    sizes = SHARED | {"tilt": TILT, "friction_zero": np.hypot(ZERO, DRIFT), "normal_zero": ZERO}
    tables = {
        name: {"value": f"{size!r} {UNITS.get(name, '')}".strip(), "as": "standard"}
        for name, size in ((name, float(size)) for name, size in sizes.items())
    }
    return tables | {"resolution": {"value": f"{STEP} N", "as": "step"}}


def scaled(level: float, speed: np.ndarray) -> np.ndarray:
    """Friction of a run whose level is its own."""
    return level * LAW(speed)


def signals_of(run) -> xr.Dataset:
    """The run as a reader would give it, both logs on one clock."""
    motion = run.noise_free[["position", "sliding_velocity"]]
    return stamp(run.force_log.merge(motion), source=run.name)


def friction_of(run: xr.Dataset, segments: xr.Dataset, offset: str, mount: str) -> xr.Dataset:
    """Friction of all segments, or of the forward ones alone without a zero taken off."""
    if offset == "none":
        segments = segments.isel(segment=np.flatnonzero(segments.direction.values > 0))
        segments = segments.drop_dims("omitted", errors="ignore")
    return tl.friction_coefficient(run, segments, offset).assign_attrs(mount=mount)


def held(data: xr.Dataset, truth: np.ndarray) -> list[bool]:
    """Whether U95 of each value holds its truth."""
    miss = np.abs(data.friction_coefficient.values - truth)
    return (miss <= data.friction_coefficient_U95.values).tolist()


def of_run(friction: xr.Dataset, truth) -> np.ndarray:
    """The run's own friction at the speed of each segment."""
    own = truth.drop_duplicates("sliding_speed_m_s")
    at = np.argmin(
        np.abs(np.log(friction.sliding_speed.values[:, None] / own.sliding_speed_m_s.values)), 1
    )
    return own.friction_coefficient.values[at]


def from_files(run, offset: str, memory: xr.Dataset) -> float:
    """Largest difference, in standard errors, of friction read from raw files."""
    with tempfile.TemporaryDirectory() as folder:
        files = write_run(run, Path(folder))
        read = tl.read(files[0])
        if read.attrs["clock_shift_source"] == "none":
            # strokes this short do not always tell what the clocks are apart, and then it is said
            read = tl.read(files[0], clock_shift=f"{run.facts['clock_shift_at_middle_s']!r} s")
        again = friction_of(read, tl.find_segments(read), offset, "")
    # the shortest strokes are 50 ms: what the clocks are apart may cost one
    speeds = np.log(again.sliding_speed.values[:, None] / memory.sliding_speed.values)
    other = again.direction.values[:, None] != memory.direction.values
    alike = memory.isel(segment=np.argmin(np.abs(speeds) + 10 * other, axis=1))
    apart = again.friction_coefficient.values - alike.friction_coefficient.values
    errors = [data.friction_coefficient_sem.values for data in (again, alike)]
    return float(np.max(np.abs(apart) / np.hypot(*errors)))


class Drawn(NamedTuple):
    """What a campaign's values share: its calibration, and of each run the level and the tilt."""

    shared: Calibration
    level: np.ndarray
    tilt: np.ndarray


def drawn(campaigns: int, seed: int) -> list[Drawn]:
    """What the campaigns' calibrations and runs are, normal with their standard uncertainties."""
    runs = max(REPEATS)
    sobol = qmc.Sobol(len(SHARED) + 2 * runs, rng=np.random.default_rng([18, seed]))
    points = special.ndtri(sobol.random_base2(int(np.ceil(np.log2(campaigns))))[:campaigns])
    shared, level, tilt = np.split(points, [len(SHARED), len(SHARED) + runs], axis=1)
    sizes = shared * np.array(list(SHARED.values()))
    calibrations = [Calibration(**dict(zip(SHARED, map(float, row), strict=True))) for row in sizes]
    return list(map(Drawn, calibrations, 1 + LEVEL * level, TILT * tilt))


def campaign(seed: int, of: Drawn, with_files: bool, counts: dict) -> float:
    """Simulate and analyse one campaign; count what its U95 hold."""
    rng = np.random.default_rng([18, seed])
    runs = []
    for number, (level, tilt) in enumerate(zip(of.level, of.tilt, strict=True), start=1):
        calibration = dataclasses.replace(of.shared, tilt=float(tilt))
        law = partial(scaled, float(level))
        given = {"rig": RIG, "law": law, "slip": NO_SLIP, "calibration": calibration}
        runs.append(simulate_run("Sb-S", "glycerol", LOAD, number, seed=rng, **given))
    apart, known = 0.0, stated()
    signals = [signals_of(run) for run in runs]
    found_in = [tl.find_segments(run) for run in signals]
    for way, offset in (("one direction", "none"), ("reversal", "half loop")):
        frictions = [
            friction_of(run, strokes, offset, f"mount {i}")
            for i, (run, strokes) in enumerate(zip(signals, found_in, strict=True))
        ]
        budgets = [tl.metrology.uncertainty_budget(friction, known).data for friction in frictions]
        truths = [of_run(data, run.segments) for data, run in zip(budgets, runs, strict=True)]
        holds = [held(data, truth) for data, truth in zip(budgets, truths, strict=True)]
        if with_files:
            apart = max(apart, from_files(runs[0], offset, frictions[0]))
        for repeats in REPEATS:
            segments = counts.setdefault((way, "segments", repeats), [])
            points = counts.setdefault((way, "curve points", repeats), [])
            segments += sum(holds[:repeats], [])
            curve = tl.metrology.uncertainty_budget(frictions[:repeats], known).data
            truth = LAW(curve.sliding_speed.values)
            if repeats == 1:
                truth = of_run(curve, runs[0].segments)
            points += held(curve, truth)
    return apart


def main() -> int:
    """Print the coverage and the verdict."""
    given = [int(text) for text in sys.argv[1:]]
    campaigns, first, files = (*given, *(500, 0, 3)[len(given) :])
    counts: dict[tuple[str, str, int], list[bool]] = {}
    apart = 0.0
    for seed, of in enumerate(drawn(campaigns, first), start=first):
        apart = max(apart, campaign(seed, of, seed < first + files, counts))
    missed = []
    for (way, what, repeats), holds in counts.items():
        share = float(np.mean(holds))
        print(f"{way:14} {what:13} {repeats} repeats: {share:6.1%} of {len(holds)}")
        if not WITHIN[0] <= share <= WITHIN[1]:
            missed.append(f"{way}, {what}, {repeats} repeats")
    print(f"read from raw files: within {apart:.2f} standard errors of what was in memory")
    if apart > 1:
        missed.append("raw files")
    print("U95 holds what it says" if not missed else f"missed: {'; '.join(missed)}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
