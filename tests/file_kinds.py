"""How a file of the rig's kinds is read, and whether its friction coefficients are right."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from layouts.kinds import WrittenRun
from scipy.stats import norm

import tribolab as tl
from tribolab.core.errors import TribolabError

AT_ONCE, DRAFTED, DESCRIBED, NOT = "directly", "after questions", "with a dialect", "not"
CHANCE = 0.00135  # of a number beyond 3 standard errors on one side


class HowRead(NamedTuple):
    """In which way a file was read, and why not at once."""

    way: str
    run: xr.Dataset | None
    why: str = ""


class Judged(NamedTuple):
    """Coefficients with their standard errors [1], their truth, and what is wrong."""

    mu: np.ndarray
    sem: np.ndarray
    truth: np.ndarray
    faults: tuple[str, ...]

    @property
    def off(self) -> np.ndarray:
        """How many standard errors each is off."""
        return np.abs(self.mu - self.truth) / self.sem


def read_in_some_way(written: WrittenRun, folder: Path) -> HowRead:
    """Read a file without a word, else with what a person types over the draft, else described."""
    kind, said = written.kind, {"zero": written.kind.zero}
    try:
        run = tl.read(written.path, **said)
        if _speed_is_known(run):
            return HowRead(AT_ONCE, run)
        why = "it does not say the speed"
    except TribolabError as error:
        why = str(error)
    ways = [(DESCRIBED, kind.dialect)] if kind.dialect else []
    try:
        toml = tl.reading.draft_dialect(written.path).toml
        for before, after in kind.typed:
            assert before in toml, f"'{before}' is not in the draft"
            toml = toml.replace(before, after)
        ways.insert(0, (DRAFTED, toml))
    except TribolabError as error:
        why = f"{why}; {error}"
    for way, text in ways[-1:]:
        dialect = folder / f"{kind.name}.toml"
        dialect.write_text(text, encoding="utf-8")
        try:
            return HowRead(way, tl.read(written.path, dialect, **said), why)
        except TribolabError as error:
            why = f"{why}; {error}"
    return HowRead(NOT, None, why)


def _speed_is_known(run: xr.Dataset) -> bool:
    signals = {"sliding_velocity", "position", "set_speed"} & set(run)
    return bool(signals) or "set_speed_m_s" in run.attrs


def judge(written: WrittenRun, run: xr.Dataset) -> Judged:
    """Compare the coefficients of a run with its truth.

    With n numbers in a run, the bound is so that one of them lies beyond it by chance as rarely as
    a single number beyond three standard errors; the two strokes of a pair are one number.
    """
    record = written.record
    if not record.motion.speed.size:
        return _judge_cycles(written, run)
    segments = tl.find_segments(run)
    friction = tl.friction_coefficient(run, segments)
    count = record.motion.speed.size
    if segments.sizes["segment"] != count:
        return _failed(f"{segments.sizes['segment']} segments for {count}")
    if "friction_coefficient" not in friction:
        return _failed("no friction coefficient: forces only")
    mu = friction["friction_coefficient"].values
    sem = friction["friction_coefficient_sem"].values
    pair = friction["pair"].values
    truth = record.friction_coefficient.copy()
    for number in range(pair.max(initial=-1) + 1):
        truth[pair == number] = truth[pair == number].mean()
    faults = _beyond(mu, sem, truth, np.unique(np.where(pair >= 0, pair, -1 - np.arange(count))))
    speed = friction["sliding_speed"].values / np.abs(record.motion.speed) - 1
    faults += [f"speed {100 * x:.1f} % off" for x in speed if abs(x) > 0.01]
    return Judged(mu, sem, truth, tuple(faults))


def _judge_cycles(written: WrittenRun, run: xr.Dataset) -> Judged:
    cycles = tl.friction.friction_per_cycle(run)
    mu = np.atleast_1d(cycles["mean_friction_coefficient"].values)
    sem = np.atleast_1d(cycles["mean_friction_coefficient_sem"].values)
    truth = np.atleast_1d(written.record.middle_friction_coefficient())
    return Judged(mu, sem, truth, tuple(_beyond(mu, sem, truth, mu)))


def _beyond(mu: np.ndarray, sem: np.ndarray, truth: np.ndarray, numbers: np.ndarray) -> list[str]:
    bound = norm.isf(CHANCE / numbers.size)
    off = np.abs(mu - truth) / sem
    return [
        f"mu {m:.5g} +- {s:.2g} for {t:.5g} ({o:.1f} standard errors)"
        for m, s, t, o in zip(mu, sem, truth, off, strict=True)
        if not o <= bound
    ]


def _failed(why: str) -> Judged:
    return Judged(np.empty(0), np.empty(0), np.empty(0), (why,))
