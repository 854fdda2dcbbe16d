"""The main job: a campaign file in, a folder of results out, whole or not at all."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

from tribolab import __version__
from tribolab.campaign.config import Campaign, load_campaign
from tribolab.campaign.executor import workers
from tribolab.campaign.ledger import Ledger
from tribolab.campaign.outcome import Outcome
from tribolab.campaign.pipeline import Progress, process
from tribolab.campaign.plan import inputs_of, scan_files
from tribolab.campaign.staging import resolved, staged
from tribolab.errors import ConfigError
from tribolab.provenance import sha256_of, sha256_of_file

FINGERPRINT = ".fingerprint"


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
    r"""Analyse a campaign and write its results: data, tables, figures and the report.

    Parameters
    ----------
    path_or_campaign
        A campaign file, or what `load_campaign` made of it.
    output
        Results folder; by default the one that the campaign file names. What an earlier run
        wrote there is replaced as a whole when everything is written; until then, and if
        anything goes wrong, it stays. Other files in it are left there.
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
        what it writes to ``outcome.folder`` appears with them. Not called if nothing at all
        has changed since the last time: then the results that are there stay.

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
    from tribolab.report.results import write_report

    campaign = path_or_campaign
    if not isinstance(campaign, Campaign):
        campaign = load_campaign(campaign)
    place = resolved(campaign.output if output is None else output)
    _keep_apart(campaign, place)
    if executor is not None and (jobs is not None or scheduler is not None):
        raise ConfigError("give either an executor, or jobs, or scheduler")
    try:
        with staged(place) as folder:
            given = contextlib.nullcontext(executor) if executor else workers(jobs, scheduler)
            with given as pool:
                outcome = process(
                    campaign, folder, executor=pool, previous=place, progress=progress
                )
                fingerprint = _fingerprint(outcome)
                if _is_complete(place, fingerprint, outcome) and _all_reused(outcome):
                    raise _Unchanged
                write_report(outcome, executor=pool, progress=progress)
            if finish is not None:
                finish(outcome)
            (folder / FINGERPRINT).write_text(fingerprint, encoding="utf-8")
    except _Unchanged:  # the staged copy is dropped; what is there is the same and complete
        pass
    return replace(outcome, folder=place, foreign=tuple(Ledger.read(place).foreign()))


class _Unchanged(Exception):  # noqa: N818 - a way out, not an error
    pass


def _fingerprint(outcome: Outcome) -> str:
    """Return the checksum of all that a report is made from."""
    campaign = outcome.campaign
    return sha256_of(
        {
            "tribolab_version": __version__,
            "campaign": sha256_of_file(campaign.file),
            "sources": outcome.sources,
            "kept": outcome.kept,
            "scans": [sha256_of_file(path) for path in scan_files(campaign)],
        }
    )


def _all_reused(outcome: Outcome) -> bool:
    surfaces = [surface for surface in outcome.surfaces if surface.files]
    models = [model for model in outcome.models if model.status != "skipped"]
    return all(part.reused for part in (*outcome.runs, *surfaces, *models))


def _is_complete(place: Path, fingerprint: str, outcome: Outcome) -> bool:
    made, ledger = place / FINGERPRINT, Ledger.read(place)
    if not ledger.is_whole or made.read_text(encoding="utf-8") != fingerprint:
        return False
    # a curve that could not be made then, for want of memory say, may be there now
    return all(curve.data_file in ledger.files for curve in outcome.curves if curve.done)


def _keep_apart(campaign: Campaign, place: Path) -> None:
    """Refuse a results folder that holds, or lies in, what the campaign reads."""
    raw = campaign.raw.resolve()
    if place.is_relative_to(raw):
        raise ConfigError(
            f"{place}: results must lie apart from the raw files; choose another folder with "
            "--output"
        )
    for file, what in [(raw, "the raw files"), *inputs_of(campaign)]:
        if file.resolve().is_relative_to(place):
            raise ConfigError(
                f"{place}: results must lie apart from what they are made from, and {what} "
                f"({file.name}) would lie in them; choose another folder with --output, or move it"
            )
