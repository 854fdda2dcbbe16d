"""Main workflow: from a campaign file to a complete results folder."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from tribolab.app.needed import ANALYSIS
from tribolab.campaign.engine.cluster import ClusterAbsent, ClusterGone
from tribolab.campaign.engine.executor import workers
from tribolab.campaign.engine.pool import LastingPool, WorkerDied
from tribolab.campaign.engine.stage import Progress
from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.files import inputs_of, own_python
from tribolab.campaign.settings.load import load_and_plan
from tribolab.campaign.settings.plan import PlannedRun, planned_runs
from tribolab.campaign.store.catalogue import Catalogue, fingerprint_of
from tribolab.campaign.store.ledger import Ledger
from tribolab.campaign.store.outcome import Outcome
from tribolab.campaign.store.staging import resolved, staged
from tribolab.campaign.store.unchanged import note, unchanged
from tribolab.core.errors import ConfigError, Cure, shown
from tribolab.report.code import code_of_page
from tribolab.report.figures.choice import wanted
from tribolab.report.table_format import table_format


def run_campaign(
    path_or_campaign: str | Path | Campaign,
    *,
    output: str | Path | None = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
    figures: str = "curves",
    pdf: bool = False,
    tables: str = "csv",
    verify: bool = False,
    outside: bool = False,
    trust: bool = False,
) -> Outcome:
    r"""Analyse a campaign and write its results: data, tables, figures and the report.

    Parameters
    ----------
    path_or_campaign
        A campaign file, or a campaign from `load_campaign`.
    output
        Results folder; by default that of the campaign file. Earlier results are replaced only
        after everything is written; if anything fails, they are kept. Other files in it are kept.
    executor
        Any `concurrent.futures.Executor` to work in.
    jobs
        Number of processes without executor; 1 uses this process only. By default one per
        processor, or 1 if the settings of only one run changed.
    scheduler
        Address of a Dask scheduler, instead of `jobs`.
    progress
        Called as ``progress(stage, done, total)``.
    figures
        Figures drawn for publication: ``"curves"`` (measured curves), ``"all"`` or ``"none"``.
    pdf
        Whether to write figures also as PDF.
    tables
        Format of the tables next to CSV: ``"xlsx"`` (one workbook) or ``"parquet"``.
    verify
        Whether to compare checksums of all raw files and results; by default unchanged raw files
        and large results are recognised by size, time and inode.
    outside
        Whether ``output`` in the campaign file may be outside the folder of that file.
    trust
        Whether Python readers named in the campaign file may run.

    Returns
    -------
    Outcome
        One record per run and curve, including failed runs.

    Raises
    ------
    ConfigError
        If the campaign file or an option is wrong.
    OutputError
        If the results cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4, 1e-3)))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = rig.write_run(rig.simulate_run("Sb-S", "dry", rig=short), Path(folder) / "raw")
    ...     file = Path(folder) / "campaign.toml"
    ...     _ = file.write_text('[campaign]\nname = "one"\n[[run]]\nfiles = "*.csv"\n')
    ...     outcome = run_campaign(file, jobs=1)
    ...     made = (outcome.folder / "report.html").is_file()
    >>> made, [(run.name, run.segments, run.quality) for run in outcome.runs]
    (True, [('sb-s_dry_31N_01', 4, 'pass')])
    """
    which, form = wanted(figures), table_format(tables)
    if isinstance(path_or_campaign, Campaign):
        campaign, runs = path_or_campaign, planned_runs(path_or_campaign)
    else:
        campaign, runs = load_and_plan(path_or_campaign)
    if not trust:
        _refuse_python_readers(campaign)
    place = resolved(campaign.output if output is None else output)
    if output is None and not outside:
        _refuse_outside_folder(campaign, place)
    _refuse_input_folder(campaign, place)
    if executor is not None and (jobs is not None or scheduler is not None):
        raise ConfigError("give either an executor, or jobs, or scheduler")
    options = {"figures": which, "pdf": pdf, "tables": form, "code": code_of_page()}
    ledger = Ledger.read(place)
    intact = ledger.intact(whole=verify)
    damaged = ledger.damaged(intact)
    known = unchanged(campaign, runs, place, options, verify=verify, intact=intact)
    if known is not None:
        return known
    if executor is None and jobs is None and scheduler is None and _is_one_changed(runs, place):
        jobs = 1  # starting processes would take longer than one run
    with staged(place) as folder:
        given = contextlib.nullcontext(executor) if executor else workers(jobs, scheduler, ANALYSIS)
        with given as pool:
            if isinstance(pool, LastingPool):  # workers and this process import at the same time
                pool.prepare()
            # imported late: not needed if nothing has changed
            from tribolab.campaign.pipeline import process
            from tribolab.report.other_tables import write_other_tables
            from tribolab.report.results import write_report

            outcome = process(
                campaign,
                folder,
                runs=runs,
                executor=pool,
                previous=place,
                progress=progress,
                verify=verify,
                intact=intact,
            )
            write_report(outcome, executor=pool, progress=progress, figures=which, pdf=pdf)
            write_other_tables(Path(outcome.folder) / "tables", form)
        note(outcome, runs, options)
        outcome.store.close()
    foreign = tuple(Ledger.read(place).foreign())
    return outcome.read_at(place, Catalogue.of(place), foreign, damaged)


def _is_one_changed(runs: Sequence[PlannedRun], place: Path) -> bool:
    """Whether exactly one run has new settings, e.g. a decision, since the last analysis."""
    known = Catalogue.of(place).fingerprints("run")
    changed = [run for run in runs if known.get(run.name) != fingerprint_of(run.config_sha256)]
    return bool(known) and len(changed) == 1


def run_here_if_lost(
    path_or_campaign: str | Path | Campaign,
    *,
    say: Callable[[str], None],
    scheduler: str | None,
    **options: Any,
) -> Outcome:
    """Run a campaign on a cluster; if that is lost or does not answer, on this computer.

    Parameters
    ----------
    path_or_campaign, scheduler, options
        As for `run_campaign`.
    say
        Called with the reason before the campaign runs on this computer.
    """
    try:
        return run_campaign(path_or_campaign, scheduler=scheduler, **options)
    except (ClusterGone, ClusterAbsent, WorkerDied) as lost:
        if scheduler is None:
            raise
        why = str(lost).split(";")[0]
        say(f"{why}; --local-if-lost: the campaign is analysed here instead")
    return run_campaign(path_or_campaign, **options)


def _matches_results(campaign: Campaign, raw: Path, place: Path) -> bool:
    """Whether patterns of raw files in the campaign could match files in the results folder."""
    depth = len(place.relative_to(raw).parts)
    patterns = [p for entry in campaign.run for p in entry.files]
    patterns += [p for surface in campaign.surface for p in surface.scans or ()]
    wild = [pattern for pattern in patterns if not (raw / pattern).is_file()]
    return depth == 0 or any("**" in p or len(Path(p).parts) > depth for p in wild)


def _refuse_python_readers(campaign: Campaign) -> None:
    """Raise if the campaign names Python readers: a foreign campaign file must not run programs."""
    for name in own_python(campaign):
        raise ConfigError(
            f"instrument = '{shown(name)}' is a Python program that belongs to the campaign; it "
            "runs only if you trust it",
            where=campaign.file,
            cure=Cure(
                notebook="read it, then use trust=True",
                terminal="read it, then use --trust",
                campaign="read it, then use --trust",
            ),
        )


def _refuse_outside_folder(campaign: Campaign, place: Path) -> None:
    """Raise if the results folder is outside the campaign's folder, as in a foreign campaign."""
    home = campaign.file.resolve().parent
    if not place.is_relative_to(home):
        raise ConfigError(
            f"campaign.output = '{shown(campaign.campaign.output)}' would write results to "
            f"{place}, outside the campaign's folder {home}",
            where=campaign.file,
            cure=Cure(
                notebook="name a folder inside it, or use output= or outside=True",
                terminal="name a folder inside it, or use --output or --i-know",
                campaign="name a folder inside it, or use --output or --i-know",
            ),
        )


def _refuse_input_folder(campaign: Campaign, place: Path) -> None:
    """Raise if the results folder is also the folder of raw files, or contains other inputs."""
    raw = campaign.raw.resolve()
    if place.is_relative_to(raw) and _matches_results(campaign, raw, place):
        raise ConfigError(
            f"{place}: results cannot be in the same folder as the raw files; choose another "
            "folder with --output"
        )
    for file, what in [(raw, "the raw files"), *inputs_of(campaign)]:
        if file.resolve().is_relative_to(place):
            raise ConfigError(
                f"{place}: the results folder would contain {what} ({file.name}), from which the "
                "results are made; choose another folder with --output, or move it"
            )
