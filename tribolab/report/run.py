"""The main job: a campaign file in, a folder of results out, whole or not at all."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

from tribolab.campaign.config import Campaign, load_campaign
from tribolab.campaign.executor import workers
from tribolab.campaign.outcome import Outcome
from tribolab.campaign.pipeline import Progress, process
from tribolab.campaign.staging import staged
from tribolab.errors import ConfigError


def run_campaign(
    path_or_campaign: str | Path | Campaign,
    *,
    output: str | Path | None = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
    finish: Callable[[Outcome], None] | None = None,
) -> Outcome:
    """Analyse a campaign and write its results: data, tables, figures and the report.

    Parameters
    ----------
    path_or_campaign
        A campaign file, or what `load_campaign` made of it.
    output
        Results folder; by default the one that the campaign file names. It is replaced as a
        whole when everything is written; until then, and if anything goes wrong, it stays.
    executor
        Any `concurrent.futures.Executor` to work in.
    jobs
        Number of processes, if no executor is given; 1 does everything here. By default one
        per processor.
    scheduler
        Address of a Dask scheduler, instead of `jobs`.
    progress
        Called as ``progress(stage, done, total)``.
    finish
        Called with the outcome when everything else is written, before the results appear;
        what it writes to ``outcome.folder`` appears with them.

    Returns
    -------
    Outcome
        One record per run and per curve; runs that failed are among them.

    Raises
    ------
    ConfigError
        If the campaign file or an option is wrong.
    OutputError
        If the results cannot be written.
    """
    from tribolab.report.results import write_report

    campaign = path_or_campaign
    if not isinstance(campaign, Campaign):
        campaign = load_campaign(campaign)
    place = Path(campaign.output if output is None else output).resolve()
    _keep_apart(campaign, place)
    if executor is not None and (jobs is not None or scheduler is not None):
        raise ConfigError("give either an executor, or jobs, or scheduler")
    with staged(place) as folder:
        given = contextlib.nullcontext(executor) if executor else workers(jobs, scheduler)
        with given as pool:
            outcome = process(campaign, folder, executor=pool, previous=place, progress=progress)
            write_report(outcome, executor=pool, progress=progress)
        if finish is not None:
            finish(outcome)
    return replace(outcome, folder=place)


def _keep_apart(campaign: Campaign, place: Path) -> None:
    raw, file = campaign.raw.resolve(), campaign.file.resolve()
    if file.is_relative_to(place) or raw.is_relative_to(place) or place.is_relative_to(raw):
        raise ConfigError(
            f"{place}: results must lie apart from the raw files and the campaign file; choose "
            "another folder with --output"
        )
