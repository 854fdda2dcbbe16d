"""Common load for repeats whose measured loads differ slightly."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tribolab.campaign.runs.loads import round_load
from tribolab.core.wording import LOAD_STATED
from tribolab.records.runs.run_record import RunRecord

if TYPE_CHECKING:
    from tribolab.campaign.runs.stage import RunHandle
    from tribolab.campaign.store.new_catalogue import Store
    from tribolab.records.parts import RunOutcome

_Own = tuple[str, float]  # name of a run, and a load measured in it [N]
_MAX_LOAD_RATIO = 1.05  # ratio of the largest to the smallest load of repeats


def share_loads(store: Store, came: Sequence[RunHandle]) -> list[RunHandle]:
    """Assign a common load to runs with similar measured loads; a stated load if one is close."""
    systems: dict[tuple[str, str], list[RunOutcome]] = {}
    for run in came:
        systems.setdefault((run.outcome.surface, run.outcome.medium), []).append(run.outcome)
    loads = {own: load for runs in systems.values() for own, load in _common_loads(runs)}
    return [_store_load(store, run, place, loads) for place, run in enumerate(came)]


def _store_load(store: Store, run: RunHandle, place: int, loads: dict[_Own, float]) -> RunHandle:
    """Store a run under its new load, if that has changed."""
    name, measured = run.outcome.name, run.outcome.measured_load
    load = run.outcome.normal_force if measured is None else loads[name, measured]
    levels = tuple(loads[name, level] for level in run.outcome.measured_levels)
    if (load, levels) == (run.outcome.normal_force, run.outcome.load_levels):
        return run
    outcome = replace(run.outcome, normal_force=load, load_levels=levels)
    if (entry := store.get("run", outcome.name, RunRecord)) is not None:
        trace = store.trace("run", outcome.name)
        record = replace(entry.record, outcome=outcome)
        store.put("run", outcome.name, place, entry.fingerprint, record, trace)
    return run._replace(outcome=outcome)


def _common_loads(runs: Iterable[RunOutcome]) -> Iterable[tuple[_Own, float]]:
    """Yield (run name, measured load) and the load assigned to it."""
    stated = [run.normal_force for run in runs if run.load_from == LOAD_STATED]
    known = [load for load in stated if load is not None and load > 0]
    measured = [(load, run.name) for run in runs for load in _measured(run)]
    group: list[tuple[float, str]] = []
    for load, name in sorted(measured):
        near = [other for other in known if 1 / _MAX_LOAD_RATIO < load / other < _MAX_LOAD_RATIO]
        if near:
            yield (name, load), min(near, key=lambda other: abs(other - load))
            continue
        if group and load > _MAX_LOAD_RATIO * group[-1][0]:
            yield from _mean_load(group)
            group = []
        group.append((load, name))
    yield from _mean_load(group)


def _measured(run: RunOutcome) -> tuple[float, ...]:
    return run.measured_levels if run.measured_load is None else (run.measured_load,)


def _mean_load(group: Sequence[tuple[float, str]]) -> Iterable[tuple[_Own, float]]:
    for own, name in group:
        yield (name, own), round_load(sum(load for load, _ in group) / len(group))
