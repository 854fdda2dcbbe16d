"""Process a whole campaign in stages on one executor: runs, curves, surfaces and models."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.curves import Curves
from tribolab.campaign.engine.pool import WorkerDied
from tribolab.campaign.engine.stage import Progress, begun, perform
from tribolab.campaign.models.stage import Models
from tribolab.campaign.odd_runs import REPEATS, add_odd_repeats
from tribolab.campaign.runs.kept import keep_runs
from tribolab.campaign.runs.repeats import share_loads
from tribolab.campaign.runs.stage import RunHandle, Runs
from tribolab.campaign.runs.zeros import lent_zeros
from tribolab.campaign.settings.plan import PlannedRun, planned_runs
from tribolab.campaign.settings.review import lost_decisions
from tribolab.campaign.store.data_files import UNFINISHED
from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.store.outcome import OpenOutcome
from tribolab.campaign.surfaces.stage import Surfaces

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign


def process(
    campaign: Campaign,
    staging: Path,
    *,
    runs: Sequence[PlannedRun] | None = None,
    executor: Executor | None = None,
    previous: Path | None = None,
    progress: Progress | None = None,
    verify: bool = False,
    intact: Container[str] | None = None,
) -> OpenOutcome:
    """Process every run and surface, combine the repeats, and compute models for the curves.

    Failures are recorded with their reason; the rest is completed. Parts of `previous` are reused
    if files, settings and version are the same.

    Parameters
    ----------
    campaign
        From `load_campaign`.
    staging
        Folder to write to; data files go to its ``data`` folder.
    runs
        From `load_and_plan`; without them the patterns are resolved here.
    executor
        Any `concurrent.futures.Executor`; None does the work here, task by task.
    previous
        Folder of earlier results, if any.
    progress
        Called as ``progress(stage, done, total)``.
    verify
        Whether to read every file again and compare checksums.
    intact
        Unchanged files of `previous`; by default all are trusted.

    Returns
    -------
    OpenOutcome
        One small record per run, curve, surface and model; everything else is in its store.

    Raises
    ------
    ConfigError
        If the campaign's patterns no longer match any file.
    OutputError
        If results cannot be written.
    WorkerDied
        If there were runs to do and every one of them lost its worker process.
    """
    runs = planned_runs(campaign) if runs is None else runs
    (staging / "data").mkdir(parents=True, exist_ok=True)
    store = Store(staging, previous, verify=verify, intact=intact)

    came = perform(Runs(runs, store), executor, progress)
    _refuse_if_all_died(came)
    came = keep_runs(campaign, store, _repeat_with_lent_zeros(runs, came, store, executor))
    came = share_loads(store, came)
    outcomes = tuple(run.outcome for run in came)
    surfacing = begun(Surfaces(campaign, outcomes, store), executor, progress)
    combining = begun(
        Curves(came, store, campaign.segments.speed_tolerance), executor, progress
    )  # while the last surfaces are done
    surfaces, curves = surfacing(), combining()
    came = add_odd_repeats(store, came, curves, skip=REPEATS in campaign.qc.skip)
    outcomes = tuple(run.outcome for run in came)
    models = perform(Models(campaign, curves, surfaces, store), executor, progress)
    for part in (staging / "data").glob(f"*{UNFINISHED}"):  # left by a worker that died
        part.unlink()
    sources = [source for run in came for source in run.sources]
    sources += [source for surface in surfaces for source in surface.sources]
    store.save()
    return OpenOutcome(
        campaign=campaign,
        folder=staging,
        store=store,
        runs=outcomes,
        curves=tuple(curve.outcome for curve in curves),
        sources=tuple({source[0]: source for source in sources}.values()),
        surfaces=tuple(surface.outcome for surface in surfaces),
        models=tuple(model.outcome for model in models),
        lost_decisions=lost_decisions(campaign.file, [run.name for run in runs]),
    )


def _repeat_with_lent_zeros(
    runs: Sequence[PlannedRun],
    came: Sequence[RunHandle],
    store: Store,
    executor: Executor | None,
) -> list[RunHandle]:
    """Repeat runs without their own zero with the zeros of other runs of the instrument."""
    zeros = {run.name: before.zero for run, before in zip(runs, came, strict=True)}
    again = lent_zeros(zeros)
    if not again:
        return list(came)
    lent = [
        replace(run, friction=run.friction | {"other_zeros": again[run.name]})
        for run in runs
        if run.name in again
    ]
    stage = Runs(runs, store).again(lent)
    done = dict(zip(again, perform(stage, executor), strict=True))
    return [done.get(run.name, before) for run, before in zip(runs, came, strict=True)]


def _refuse_if_all_died(came: Iterable[RunHandle]) -> None:
    """Raise if every worker died, so that empty results do not replace good ones."""
    done = [run.outcome for run in came if not run.outcome.reused]
    if done and all(outcome.error == WorkerDied.__name__ for outcome in done):
        raise WorkerDied(f"no run could be analysed: {done[0].name}: {done[0].reason}")
