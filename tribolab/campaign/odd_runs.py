"""Detect runs that contradict their repeats, once all curves of a campaign are known."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tribolab.campaign.runs.stage import RunHandle
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.wording import percent
from tribolab.records.part_records import CurveRecord
from tribolab.records.runs.run_record import CheckRow, RunRecord
from tribolab.records.runs.running_in_record import steady_levels

REPEATS = "repeats"
_VARIABLE = "friction_coefficient"
_LEAST_SHOWN = 1e-4  # smallest scatter that is shown
_BY_HAND = ("accepted", "rejected")


class _Condition(NamedTuple):
    """Names of the repeats under one condition, and their friction: relative level, or steady µ."""

    runs: tuple[str, ...]
    levels: np.ndarray


def add_odd_repeats(
    store: Store, runs: Sequence[RunHandle], curves: Iterable[CurveRecord], *, skip: bool = False
) -> list[RunHandle]:
    """Mark the runs that differ from their repeats by far more than other repeats do.

    Parameters
    ----------
    store
        Store with the records of the runs, which are updated.
    runs
        The runs with their outcomes.
    curves
        Records of the measured curves.
    skip
        Whether the check is switched off.
    """
    found = () if skip else (_condition(store, curve) for curve in curves)
    conditions = [condition for condition in found if condition is not None]
    checks = _verdicts(conditions)
    return [_update_run(store, run, place, checks) for place, run in enumerate(runs)]


def _condition(store: Store, curve: CurveRecord) -> _Condition | None:
    pairs = zip(curve.outcome.run_names, curve.levels, strict=False)
    levels = {name: level for name, level in pairs if level is not None and level > 0}
    if len(levels) < 2:
        return None
    if len(curve.points) == 1:
        entries = {name: store.get("run", name, RunRecord) for name in levels}
        rows = {name: entry.record.facts.running_in for name, entry in entries.items() if entry}
        levels = steady_levels(rows) or levels
    return _Condition(tuple(levels), np.array(list(levels.values()), dtype=float))


def _verdicts(conditions: Sequence[_Condition]) -> dict[str, CheckRow]:
    """Return the result of the check of repeats for each repeated run, by name."""
    from tribolab.friction.points.odd_repeats import odd_repeats  # imported late for a quick start

    checks: dict[str, CheckRow] = {}
    alone = len(conditions) == 1 and len(conditions[0].runs) < 3
    sound = (
        "agrees with its repeats as well as they agree with each other"
        if len(conditions) == 1
        else "agrees with its repeats as well as repeats under other conditions do"
    )
    for condition in conditions:
        for name in condition.runs:
            text = "only one condition was repeated, and only twice, so repeatability is unknown"
            checks[name] = _row("skipped", text) if alone else _row("pass", sound)
    for odd in odd_repeats([np.log(condition.levels) for condition in conditions]):
        runs = conditions[odd.condition].runs
        scatter = percent(max(odd.repeatability, _LEAST_SHOWN))
        least = "less than " * (odd.repeatability < _LEAST_SHOWN)
        usual = f"while repeats otherwise differ by {least}{scatter} (standard deviation)"
        if odd.repeat < 0:
            for name, other in (runs, runs[::-1]):
                text = (
                    f"friction differs from that of its repeat {other} by "
                    f"{percent(odd.deviation)}, {usual}. The mean of the two is doubtful. Repeat "
                    "the measurement, or reject the wrong run in review.toml"
                )
                checks[name] = _row("suspect", text, odd.deviation)
            continue
        name = runs[odd.repeat]
        side = "above" if odd.deviation > 0 else "below"
        text = (
            f"friction is {percent(abs(odd.deviation))} {side} that of its {len(runs) - 1} "
            f"repeats, {usual}. The run is still included in the mean. Check mounting, zero and "
            "specimen; reject the run in review.toml if it is wrong"
        )
        checks[name] = _row("suspect", text, odd.deviation)
    return checks


def _row(status: str, message: str, value: float | None = None) -> CheckRow:
    return CheckRow(REPEATS, status, _VARIABLE, message, value, "1")


def _update_run(store: Store, run: RunHandle, place: int, checks: dict[str, CheckRow]) -> RunHandle:
    """Store a run with the new result of the check instead of its earlier one."""
    name, quality = run.outcome.name, run.outcome.quality
    entry = store.get("run", name, RunRecord)
    if entry is None:
        return run
    before = entry.record.facts.checks
    others = tuple(row for row in before if row.check != REPEATS)
    own = checks.get(name)
    if own is not None and own.status == "suspect" and quality in _BY_HAND:
        own = replace(own, decision=f"the run was {quality} by hand")
    rows = others if own is None else (*others, own)
    if rows == before:
        return run
    suspect = any(row.status == "suspect" and not row.decision for row in rows)
    if quality in ("pass", "suspect"):
        quality = "suspect" if suspect else "pass"
    outcome = replace(run.outcome, quality=quality)
    record = replace(entry.record, outcome=outcome, facts=replace(entry.record.facts, checks=rows))
    trace = store.trace("run", name)
    store.put("run", name, place, entry.fingerprint, record, trace)
    return run._replace(outcome=outcome)
