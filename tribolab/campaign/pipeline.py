"""A whole campaign: runs, surfaces and models in workers, repeats combined into curves."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from traceback import format_exception
from typing import TYPE_CHECKING

from tribolab.campaign.executor import WorkerDied, completed
from tribolab.campaign.kept import Earlier, keep_runs, kept_model, kept_surface, link
from tribolab.campaign.model_plan import plan_models
from tribolab.campaign.model_work import (
    ModelTask,
    earlier_model,
    failed_model,
    known_model,
    process_model,
)
from tribolab.campaign.outcome import CurveOutcome, ModelOutcome, Outcome, RunOutcome
from tribolab.campaign.plan import PlannedRun, distinct, plan, safe_name
from tribolab.campaign.problems import message
from tribolab.campaign.surface_plan import plan_surfaces
from tribolab.campaign.surface_work import (
    SurfaceRecord,
    SurfaceTask,
    failed_surface,
    known_surface,
    process_surface,
    sources_of,
)
from tribolab.campaign.work import (
    QUALITY,
    UNFINISHED,
    CurveTask,
    RunRecord,
    RunTask,
    Source,
    checksums,
    explain,
    failed_run,
    process_curve,
    process_run,
)
from tribolab.campaign.zeros import RunZero, to_lend, zero_of
from tribolab.errors import ConfigError, OutputError, TribolabError
from tribolab.provenance import as_text, sha256_of_file

if TYPE_CHECKING:
    from tribolab.campaign.config import Campaign
    from tribolab.campaign.outcome import SurfaceOutcome

Progress = Callable[[str, int, int], None]


def process(
    campaign: Campaign,
    staging: Path,
    *,
    executor: Executor | None = None,
    previous: Path | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Process every run and surface, combine the repeats, and compute models beside them.

    What fails is recorded with the reason; the rest is done. Data files of
    `previous` are taken over where raw files (by sha256), settings and version are the same.

    Parameters
    ----------
    campaign
        From `load_campaign`.
    staging
        Folder to write to; data files go to its ``data`` folder.
    executor
        Any `concurrent.futures.Executor`; without one everything is done here, run by run.
    previous
        Folder of earlier results, if there is one.
    progress
        Called as ``progress(stage, done, total)``.

    Returns
    -------
    Outcome
        With one record per run, curve, surface and model.

    Raises
    ------
    ConfigError
        If the campaign's patterns no longer match any file.
    OutputError
        If results cannot be written.
    WorkerDied
        If there were runs to do and every one of them lost its worker process.
    """
    runs, problems = plan(campaign)
    if problems:
        raise ConfigError(message(problems, campaign.file, campaign.file.read_text("utf-8-sig")))
    (staging / "data").mkdir(parents=True, exist_ok=True)
    tell = progress or (lambda stage, done, total: None)

    records = _taken_over(runs, previous, staging)
    left = [RunTask(run, staging) for run in runs if run.name not in records]
    tell("runs", len(records), len(runs))
    for task, future in completed(executor, process_run, left):
        records[task.run.name] = _record(task, future.exception() or future.result(), staging)
        tell("runs", len(records), len(runs))
    _refuse_if_all_died(records[task.run.name].outcome for task in left)
    _lend_zeros(runs, records, staging, executor)
    earlier = Earlier.read(previous)
    ordered = keep_runs(campaign, earlier, staging, [records[run.name] for run in runs])
    outcomes = tuple(record.outcome for record in ordered)
    surfaces = _surfaces(campaign, outcomes, staging, previous, executor, tell)
    curves = _curves(outcomes, staging, executor, tell)
    found = [record.outcome for record in surfaces]
    models = _models(campaign, curves, found, staging, previous, executor, tell)
    for part in (staging / "data").glob(f"*{UNFINISHED}"):  # of a worker that died while writing
        part.unlink()
    return Outcome(
        campaign=campaign,
        folder=staging,
        runs=outcomes,
        curves=curves,
        sources=_unique(source for record in (*ordered, *surfaces) for source in record.sources),
        surfaces=tuple(found),
        models=models,
    )


def _lend_zeros(
    runs: Iterable[PlannedRun],
    records: dict[str, RunRecord],
    staging: Path,
    executor: Executor | None,
) -> None:
    """Do runs again whose zero only other runs of the instrument tell."""
    again = to_lend({run.name: records[run.name].zero for run in runs})
    tasks = [
        RunTask(replace(run, friction=run.friction | {"other_zeros": again[run.name]}), staging)
        for run in runs
        if run.name in again
    ]
    for task, future in completed(executor, process_run, tasks):
        records[task.run.name] = _record(task, future.exception() or future.result(), staging)


def _record(task: RunTask, answer: RunRecord | BaseException, staging: Path) -> RunRecord:
    """Judge what came back from a worker."""
    if isinstance(answer, OutputError):
        raise answer
    if isinstance(answer, BaseException):  # the worker could not even say what went wrong
        return RunRecord(failed_run(task.run, *explain(answer)), ())
    if answer.outcome.done and not (staging / answer.outcome.data_file).is_file():
        raise OutputError(
            f"{answer.outcome.data_file}: written by a worker, but not to be seen in {staging}; do "
            "the workers share this folder?"
        )
    return answer


def _refuse_if_all_died(outcomes: Iterable[RunOutcome]) -> None:
    """Do not let results in which nothing could be done replace good ones."""
    outcomes = list(outcomes)
    if outcomes and all(outcome.error == WorkerDied.__name__ for outcome in outcomes):
        raise WorkerDied(f"no run could be done: of {outcomes[0].name}, {outcomes[0].reason}")


def _taken_over(
    runs: Iterable[PlannedRun], previous: Path | None, staging: Path
) -> dict[str, RunRecord]:
    """Take over the data files of earlier results that are still true."""
    if previous is None or not (previous / "data").is_dir():
        return {}
    candidates = [
        (run, known)
        for run in runs
        if (known := _known(previous / "data" / f"{run.name}.nc", run)) is not None
    ]
    taken = {}
    with ThreadPoolExecutor(4) as threads:  # hashing releases the interpreter's lock
        sums = threads.map(_checksums, [run.files for run, _ in candidates])
        for (run, (known, outcome, zero)), sources in zip(candidates, sums, strict=True):
            if known == sorted((name, checksum) for name, checksum, _ in sources):
                try:
                    link(previous / outcome.data_file, staging / outcome.data_file)
                except FileNotFoundError:  # replaced by another process meanwhile: done anew
                    continue
                rows = zip(run.labels, sources, strict=True)
                taken[run.name] = RunRecord(
                    outcome, tuple((n, c, b) for n, (_, c, b) in rows), zero
                )
    return taken


def _known(path: Path, run: PlannedRun) -> tuple[list[tuple[str, str]], RunOutcome, RunZero] | None:
    """Checksums, outcome and zero of an earlier data file, if settings and version are the same."""
    from tribolab import __version__
    from tribolab.io.netcdf import opened

    if not path.is_file():
        return None
    try:
        with opened(path) as file:
            attrs = file["run"].__dict__
            segments = len(file["segments"].dimensions["segment"])
            complete = "friction" in file.groups
            friction = file["friction"].__dict__ if complete else {}
    except (OSError, RuntimeError, LookupError):  # damaged: done anew
        return None
    same = (attrs.get("config_sha256"), attrs.get("tribolab_version"))
    if not complete or same != (run.config_sha256, __version__):
        return None
    load = run.normal_force
    if load is None and "set_normal_force_N" in attrs:
        load = float(attrs["set_normal_force_N"])
    outcome = RunOutcome(
        name=run.name,
        files=run.labels,
        surface=run.surface,
        medium=run.medium,
        normal_force=load,
        status="done",
        data_file=f"data/{path.name}",
        reused=True,
        segments=segments,
        quality=str(attrs.get(QUALITY, "")),
    )
    return (
        checksums(attrs),
        outcome,
        zero_of(friction, str(attrs.get("instrument", "")), run.instrument),
    )


def _checksums(files: Iterable[Path]) -> list[Source]:
    try:
        return [(as_text(file.name), sha256_of_file(file), file.stat().st_size) for file in files]
    except OSError:  # vanished: nothing is the same; processing it says why
        return []


def _curves(
    runs: Iterable[RunOutcome], staging: Path, executor: Executor | None, tell: Progress
) -> tuple[CurveOutcome, ...]:
    groups: dict[tuple, list[RunOutcome]] = {}
    for run in runs:
        if run.done and run.segments and run.quality not in ("fail", "error"):
            # only what is stated to be the same is taken together
            alone = "" if run.surface or run.medium else run.name
            load = run.normal_force and float(f"{run.normal_force:.4g}")
            groups.setdefault((run.surface, run.medium, load, alone), []).append(run)
    names = distinct(_curve_name(*key) for key in groups)
    tasks = [
        CurveTask(
            CurveOutcome(
                name=name,
                surface=surface,
                medium=medium,
                normal_force=load,
                data_file=f"data/{name}.nc",
                run_names=tuple(run.name for run in members),
            ),
            tuple(run.data_file for run in members),
            staging,
        )
        for name, ((surface, medium, load, _), members) in zip(names, groups.items(), strict=True)
    ]
    done: dict[str, CurveOutcome] = {}
    for task, future in completed(executor, process_curve, tasks):
        error = future.exception()
        if isinstance(error, OutputError):
            raise error
        curve = task.curve
        if error is not None:
            crash = "" if isinstance(error, TribolabError) else "".join(format_exception(error))
            reason = explain(error)[0]
            curve = replace(curve, data_file="", status="failed", reason=reason, crash=crash)
        done[curve.name] = curve
        tell("curves", len(done), len(tasks))
    return tuple(done[task.curve.name] for task in tasks)


def _surfaces(
    campaign: Campaign,
    runs: Iterable[RunOutcome],
    staging: Path,
    previous: Path | None,
    executor: Executor | None,
    tell: Progress,
) -> tuple[SurfaceRecord, ...]:
    """Process the surfaces, or take them over; the runs tell at which loads."""
    planned = plan_surfaces(campaign, runs)
    records: dict[str, SurfaceRecord] = {}
    for surface in planned:
        known = previous and known_surface(previous / surface.data_file, surface)
        if known and known[0] == sources_of(surface):
            try:
                link(previous / surface.data_file, staging / surface.data_file)
            except FileNotFoundError:  # replaced by another process meanwhile: done anew
                continue
            records[surface.name] = SurfaceRecord(known[1], known[0])
    left = [SurfaceTask(surface, staging) for surface in planned if surface.name not in records]
    for task, future in completed(executor, process_surface, left):
        error = future.exception()
        if isinstance(error, OutputError):
            raise error
        if error is not None:  # the worker could not even say what went wrong
            outcome = failed_surface(task.surface, *explain(error))
            record = SurfaceRecord(outcome, ())
        else:
            record = future.result()
        kept = kept_surface(campaign, task.surface, previous, staging, record)
        records[task.surface.name] = kept
        tell("surfaces", len(records), len(planned))
    return tuple(records[surface.name] for surface in planned)


def _models(
    campaign: Campaign,
    curves: Iterable[CurveOutcome],
    surfaces: Iterable[SurfaceOutcome],
    staging: Path,
    previous: Path | None,
    executor: Executor | None,
    tell: Progress,
) -> tuple[ModelOutcome, ...]:
    """Compute the models beside the measured curves, or take them over."""
    planned = plan_models(campaign, curves, surfaces, staging)
    done: dict[str, ModelOutcome] = {}
    for model in planned:
        known = previous and known_model(previous / model.data_file, model)
        if known:
            try:
                link(previous / model.data_file, staging / model.data_file)
            except FileNotFoundError:  # replaced by another process meanwhile: done anew
                continue
            done[model.name] = known
    left = [ModelTask(model, staging) for model in planned if model.name not in done]
    left.sort(key=lambda task: not task.model.uncertain)  # what takes longest begins first
    for task, future in completed(executor, process_model, left):
        error = future.exception()
        if isinstance(error, OutputError):
            raise error
        if error is not None:  # the worker could not even say what went wrong
            model = failed_model(task.model, *explain(error))
        else:
            model = future.result()
        if previous is not None:
            earlier = earlier_model(previous / task.model.data_file, task.model)
            model = kept_model(model, earlier, previous, staging)
        done[task.model.name] = model
        tell("models", len(done), len(planned))
    return tuple(done[model.name] for model in planned)


def _curve_name(surface: str, medium: str, load: float | None, alone: str) -> str:
    parts = [surface, medium, "" if load is None else f"{load:g}N", alone]
    return f"curve_{safe_name('_'.join(part for part in parts if part))}"


def _unique(sources: Iterable[Source]) -> tuple[Source, ...]:
    return tuple({source[0]: source for source in sources}.values())
