"""What a user gets for a trial, and whether it is right, unsure or wrong.

A run is judged by its segments; their standard error is U95, which the page shows, over 1.96. With
k independent estimates (a half loop is one) in a run, one of them lies beyond z standard errors by
chance more often than a single one does. So that a run of any length is called wrong by chance as
rarely as one number beyond three standard errors (0.27 %), the bound is z(k) = Phi^-1(1 -
0.00135/k): 3 for one, 3.6 for ten, 4.2 for a hundred. How many runs have a segment beyond 3 is
counted beside it.
"""

from __future__ import annotations

import traceback
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.stats import norm

import tribolab as tl
from tribolab.core.errors import TribolabError
from tricky.trial import Trial

CLEAR = ("pass", "skipped")
INSIDE = 0.9  # share of a trimmed segment that has to lie within a plateau
SPEED = 0.05  # relative error of a sliding speed that is wrong
CHANCE = 0.00135


@dataclass(frozen=True)
class Verdict:
    """How a run came out: "right", "unsure", "wrong" or "lost" (passed, but with parts missing).

    `off` says whether something is wrong, whatever the status, and `beyond` whether a segment lies
    more than 3 standard errors off.
    """

    outcome: str
    status: str
    off: bool
    beyond: bool
    words: str
    objections: str = ""
    mu: tuple[float, ...] = ()


def read_trial(trial: Trial, folder: Path) -> xr.Dataset:
    """Read the run as a user would; files go to `folder`."""
    if isinstance(trial.data, xr.Dataset):
        return trial.data
    for name, text in trial.data.items():
        (folder / name).write_text(text, "utf-8")
    return tl.read(folder / main_file(trial), write_dialects(trial, folder))


def main_file(trial: Trial) -> str:
    """Name of the run's own file."""
    return next(iter(trial.data))


def write_dialects(trial: Trial, folder: Path) -> Path:
    """Write the dialects; without one, it is drafted from the file, and taken as it comes."""
    if not trial.dialects:
        draft = tl.reading.draft_dialect(folder / main_file(trial))
        if draft.to_fill_in:
            raise TribolabError(f"the draft asks: {'; '.join(draft.to_fill_in.values())}")
        (folder / f"{draft.name}.toml").write_text(draft.toml, "utf-8")
        return folder / f"{draft.name}.toml"
    for name, toml in trial.dialects.items():
        text = toml.replace("{folder}", str(folder))
        (folder / f"{name}.toml").write_text(text, "utf-8")
    return folder / f"{next(iter(trial.dialects))}.toml"


def judge(trial: Trial, folder: Path) -> Verdict:
    """Analyse one trial with the public functions and compare it with its truth."""
    warnings.simplefilter("ignore")
    try:
        run = read_trial(trial, folder)
        segments = tl.find_segments(run)
        if trial.drop:
            keep = [i for i in range(segments.sizes["segment"]) if i not in trial.drop]
            segments = segments.isel(segment=keep)
        friction = tl.friction_coefficient(run, segments, **trial.settings)
        found = tl.check(run, segments, friction=friction, **trial.checks)
    except TribolabError as error:
        return Verdict("unsure", "refused", False, False, str(error))
    except Exception:
        return Verdict("wrong", "crash", True, False, traceback.format_exc(limit=-3))
    objections = "; ".join(
        f"{row['check']} {row['status']}: {row['message']}"
        for row in found.rows
        if row["status"] not in CLEAR
    )
    verdict = compare(trial, run, friction, found.status)
    return replace(verdict, objections=objections)


def compare(trial: Trial, run: xr.Dataset, friction: xr.Dataset, status: str) -> Verdict:
    """Compare the reported segments with the truth."""
    faults, beyond, matched = [], False, []
    origin = float(run.attrs.get("time_origin_s", run["time"].values[0])) - float(
        run["time"].values[0]
    )
    nothing = np.full(friction.sizes["segment"], np.nan)
    known = "friction_coefficient" in friction
    mu = friction["friction_coefficient"].values if known else nothing
    sem = nothing  # the page and the points of a curve show the wider of the two errors
    if known:
        errors = (friction[f"friction_coefficient{end}_U95"].values for end in ("", "_beyond"))
        sem = np.fmax(*errors) / norm.isf(0.025)
    reported = np.flatnonzero(np.isfinite(mu))
    truths = np.full(mu.size, np.nan)
    for i in reported:
        start = float(friction["trimmed_start"][i]) + origin
        stop = float(friction["trimmed_stop"][i]) + origin
        which, window = _plateau(trial, start, stop)
        speed = float(friction["sliding_speed"][i])
        true_speed = abs(trial.truth.speed[which]) if which >= 0 else np.nan
        if which < 0 and "stroke_middle" in friction.attrs:  # the page says that speed varies there
            true_speed = trial.truth.mean_speed(start, stop)
        if not np.isfinite(true_speed):
            faults.append(f"{start:.4g} to {stop:.4g} s: mu {mu[i]:.4g} where no speed is constant")
            continue
        if which >= 0:
            matched.append(which)
        truths[i] = trial.truth.mean(*window)
        if np.isfinite(speed) and abs(speed - true_speed) > SPEED * true_speed:
            faults.append(f"{start:.4g} s: speed {speed:.4g} for {true_speed:.4g} m/s")
    pair = friction["pair"].values
    if trial.pair_truth:
        for number in range(pair.max(initial=-1) + 1):
            truths[pair == number] = truths[pair == number].mean()
    independent = max(1, len({(p if p >= 0 else -2 - i) for i, p in enumerate(pair)}))
    bound = float(norm.isf(CHANCE / independent))
    for i in reported[np.isfinite(truths[reported])]:
        off = abs(mu[i] - truths[i])
        error = sem[i] if np.isfinite(sem[i]) else 0.0
        beyond |= bool(off > 3 * error + 1e-9 * abs(truths[i]))
        if off > bound * error + 1e-9 * abs(truths[i]):
            at = float(friction["trimmed_start"][i]) + origin
            faults.append(
                f"{at:.4g} s: mu {mu[i]:.5g} for {truths[i]:.5g}, sem {error:.2g} "
                f"({off / error if error else np.inf:.1f} sem)"
            )
    faults += _clock(trial, run)
    missing = trial.truth.start.size - len(trial.drop) - len(set(matched))
    split = len(matched) - len(set(matched))
    words = f"offset: {friction.attrs.get('offset', '')}; " + "; ".join(faults[:4])
    if len(faults) > 4:
        words += f"; and {len(faults) - 4} more"
    if missing > 0 or split:
        words += f"; {missing} of {trial.truth.start.size} plateaus missing, {split} split"
    if status not in CLEAR:
        outcome = "unsure"
    elif faults or trial.unsure_only or (trial.lost_is_wrong and missing > 0):
        outcome = "wrong"
    elif not reported.size:
        outcome, words = "wrong", "passed without any segment"
    elif missing > 0 or split:
        outcome = "lost"
    else:
        outcome = "right"
    return Verdict(outcome, status, bool(faults), beyond, words, mu=tuple(mu.tolist()))


def _clock(trial: Trial, run: xr.Dataset) -> list[str]:
    """What is wrong with the shift of a companion's clock."""
    if trial.clock_shift is None:
        return []
    shift = float(run.attrs.get("clock_shift_s", np.nan))
    error = float(run.attrs.get("clock_shift_uncertainty_s", np.nan))
    off = abs(shift - trial.clock_shift)
    if off <= 3 * error:
        return []
    return [f"clock shift {shift:.4g} s for {trial.clock_shift:.4g} s, uncertainty {error:.2g} s"]


def _plateau(trial: Trial, start: float, stop: float) -> tuple[int, tuple[float, float]]:
    """Plateau that the window lies in, -1 if none, and what they have in common."""
    truth = trial.truth
    if not truth.start.size:
        return -1, (start, stop)
    first = np.maximum(truth.start, start)
    last = np.minimum(truth.stop, stop)
    which = int(np.argmax(last - first))
    common = last[which] - first[which]
    if common < INSIDE * (stop - start):
        return -1, (start, stop)
    return which, (float(first[which]), float(last[which]))
