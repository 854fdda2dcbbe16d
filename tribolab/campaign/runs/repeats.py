"""Repeats of which no load was stated, under one load: no two measure quite the same."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tribolab.campaign.runs.loads import rounded_load
from tribolab.records.run_record import RunRecord
from tribolab.words import LOAD_STATED

if TYPE_CHECKING:
    from tribolab.campaign.runs.stage import RunCame
    from tribolab.campaign.store.catalogue import Store
    from tribolab.records.parts import RunOutcome

_ALIKE = 1.05  # largest over smallest of the loads of runs that are meant to be one


def with_loads_alike(store: Store, came: Sequence[RunCame]) -> list[RunCame]:
    """Give repeats whose load was measured one load, that which others state if there is one."""
    systems: dict[tuple[str, str], list[RunOutcome]] = {}
    for run in came:
        systems.setdefault((run.outcome.surface, run.outcome.medium), []).append(run.outcome)
    loads = {name: load for runs in systems.values() for name, load in _alike(runs)}
    return [_filed(store, run, place, loads) for place, run in enumerate(came)]


def _filed(store: Store, run: RunCame, place: int, loads: dict[str, float]) -> RunCame:
    """Write a run down under its load, if that is another."""
    load = loads.get(run.outcome.name)
    if load is None or load == run.outcome.normal_force:
        return run
    outcome = replace(run.outcome, normal_force=load)
    if (entry := store.get("run", outcome.name, RunRecord)) is not None:
        trace = store.trace("run", outcome.name)
        record = replace(entry.record, outcome=outcome)
        store.put("run", outcome.name, place, entry.fingerprint, record, trace)
    return run._replace(outcome=outcome)


def _alike(runs: Iterable[RunOutcome]) -> Iterable[tuple[str, float]]:
    """Return the names of runs whose load was measured, each with the load it is filed under."""
    stated = [run.normal_force for run in runs if run.load_from == LOAD_STATED]
    known = [load for load in stated if load is not None and load > 0]
    measured = [(run.measured_load, run.name) for run in runs if run.measured_load is not None]
    group: list[tuple[float, str]] = []
    for load, name in sorted(measured):
        near = [other for other in known if 1 / _ALIKE < load / other < _ALIKE]
        if near:
            yield name, min(near, key=lambda other: abs(other - load))
            continue
        if group and load > _ALIKE * group[-1][0]:
            yield from _as_one(group)
            group = []
        group.append((load, name))
    yield from _as_one(group)


def _as_one(group: Sequence[tuple[float, str]]) -> Iterable[tuple[str, float]]:
    for _, name in group:
        yield name, rounded_load(sum(load for load, _ in group) / len(group))
