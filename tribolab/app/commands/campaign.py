"""Commands that make a campaign, analyse it, and reproduce the paper."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tribolab.app.progress import progress_bars
from tribolab.app.questions.stated import LoadOption, RadiusOption, RateOption, SpeedOption, Stated
from tribolab.app.reported import (
    UNREADABLE,
    Debug,
    InstrumentOption,
    Jobs,
    Quiet,
    leaving,
    reported,
)
from tribolab.app.streams import say

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_FIGURES = "'tribolab figures' draws all figures"


def run(
    campaign: Annotated[
        list[Path] | None,
        typer.Argument(
            help="A folder of raw files or with campaign.toml, a campaign file, or raw files.",
            show_default="this folder",
        ),
    ] = None,
    instrument: InstrumentOption = None,
    load: LoadOption = None,
    radius: RadiusOption = None,
    speed: SpeedOption = None,
    rate: RateOption = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Output folder; your own files in it are kept.",
            show_default="stated in the campaign file, or results/ next to it",
        ),
    ] = None,
    jobs: Jobs = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            help="Address of a Dask scheduler that runs the analysis, e.g. tcp://10.0.0.5:8786.",
            show_default=False,
        ),
    ] = None,
    local_if_lost: Annotated[
        bool,
        typer.Option(
            "--local-if-lost",
            help="Analyse on this computer if the Dask cluster is unavailable or lost.",
        ),
    ] = False,
    figures: Annotated[str, leaving("--figures", _FIGURES)] = "curves",
    pdf: Annotated[bool, leaving("--pdf", _FIGURES)] = False,
    tables: Annotated[
        str, typer.Option(help="Tables next to CSV: xlsx (one workbook with units) or parquet.")
    ] = "csv",
    i_know: Annotated[
        bool,
        typer.Option(
            "--i-know", help="Allow the campaign file to read and write outside its own folder."
        ),
    ] = False,
    trust: Annotated[
        bool,
        typer.Option("--trust", help="Allow the Python readers named in the campaign file to run."),
    ] = False,
    verify: Annotated[
        bool,
        typer.Option(
            "--verify",
            help="Detect changes by the content of raw files and results, not by size and time.",
        ),
    ] = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Analyse a folder or a campaign: friction of every run, measured curves, report.

    Raw files are never changed. Results are written completely or not at all, and only changed
    parts are computed again. For raw files a campaign.toml is written first, with runs, scans, and
    repeats grouped by file name. Complete it with your knowledge of the measurement.

        tribolab run my_folder/

        tribolab run campaign.toml

        tribolab run raw/disc_07.csv raw/disc_08.csv

        tribolab run odd.txt --instrument odd.toml

        tribolab run campaign.toml --output /tmp/results --jobs 4
    """
    with reported(debug, audience="campaign"):
        # imported late for a quick start
        from tribolab.app.first_campaign import campaign_file, results_of, why_unread, withdraw
        from tribolab.app.run import run_campaign, run_here_if_lost

        run_it = partial(run_here_if_lost, say=partial(say, to_stderr=True))
        campaign = campaign or [Path()]
        stated = Stated.of(load, radius, speed, rate)
        raw = all(path.is_file() and path.suffix != ".toml" for path in campaign)
        if raw and instrument is None and not any(stated):
            # imported late: a campaign file or a folder raises no questions
            from tribolab.app.info.describing import describe_by_questions

            if described := describe_by_questions(campaign, keep=True):
                instrument = str(described)
        file, written = campaign_file(campaign, Path(), instrument, stated)
        place = output or file.parent / results_of(file)
        new_folder = written and not place.exists()
        try:
            with progress_bars(quiet) as progress:
                outcome = (run_it if local_if_lost else run_campaign)(
                    file,
                    output=output,
                    jobs=jobs,
                    scheduler=scheduler,
                    progress=progress,
                    figures=figures,
                    pdf=pdf,
                    tables=tables,
                    verify=verify,
                    outside=i_know,
                    trust=trust or written,  # if written, the command line named the instrument
                )
        except BaseException:
            if written:
                withdraw(file)
            raise
        # imported late: fast after the analysis, which has loaded the same modules
        from tribolab.app import terminal

        if new_folder and not any(part.done for part in (*outcome.runs, *outcome.surfaces)):
            withdraw(file, place)  # so that the next attempt starts afresh
            for line in why_unread(campaign, instrument) or terminal.failure_lines(outcome):
                say(f"tribolab: {line}", to_stderr=True)
            raise typer.Exit(UNREADABLE)
        if written:
            say(f"{file} was written. Add what you know: geometry, media, uncertainties")
        for line in () if i_know or written else terminal.outside_lines(outcome.campaign):
            say(f"tribolab: {line}", to_stderr=True)
        code = show_outcome(outcome, debug)
    raise typer.Exit(code)


def new(
    folder: Annotated[Path, typer.Argument(help="Folder of the raw files.")] = Path(),
    debug: Debug = False,
) -> None:
    """Write a commented campaign.toml for the raw files of a folder, without running it.

    tribolab new my_folder/
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.new_campaign import write_new_campaign

        say(f"{write_new_campaign(folder)} was written: complete it, then tribolab run {folder}")


def figures(
    campaign: Annotated[
        Path, typer.Argument(help="The campaign file (TOML), or the folder with campaign.toml.")
    ],
    pdf: Annotated[bool, typer.Option("--pdf", help="Also write them as PDF.")] = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Draw all figures for publication: surfaces, models and sliding, too.

    `tribolab run` draws only the measured curves. Its results are reused.

        tribolab figures campaign.toml --pdf
    """
    with reported(debug, audience="campaign"):
        # imported late for a quick start
        from tribolab.app.run import run_campaign

        with progress_bars(quiet) as progress:
            outcome = run_campaign(campaign, jobs=jobs, progress=progress, figures="all", pdf=pdf)
        say(f"figures: {outcome.folder / 'figures'}")


def show_outcome(outcome: Outcome, debug: bool) -> int:
    """Print the outcome of a campaign, with tracebacks of crashes if `debug`; return exit code."""
    # imported late for a quick start
    from tribolab.app import result_tables, terminal
    from tribolab.app.console import console
    from tribolab.qc.findings import exit_code

    say(terminal.verdict_line(outcome))
    table = result_tables.outcome_table(outcome)
    if table.row_count:
        console().print(table)
    more = result_tables.answer_table(outcome) or result_tables.points_table(outcome)
    if more is not None:
        console().print()
        console().print(more)
    for lines in (terminal.outcome_lines, terminal.where_to_look, terminal.foreign_lines):
        for line in lines(outcome):
            say(line)
    for line in terminal.failure_lines(outcome):
        say(f"tribolab: {line}", to_stderr=True)
    crashes = [curve.crash for curve in outcome.curves if curve.crash]
    for crash in crashes if debug else ():
        say(crash, to_stderr=True)
    nothing = bool(outcome.campaign.run) and not outcome.segments
    nothing = nothing and not any(run.ramp for run in outcome.runs)
    if nothing and len(outcome.failed) < len(outcome.runs):  # else failure_lines gives reasons
        say(
            "tribolab: no run contains a segment of constant speed (why: the check `segments`, "
            "above); `drift` and `min_samples` of [qc] limits.segments define constant",
            to_stderr=True,
        )
    spoilt = (
        outcome.failed
        or outcome.lost_decisions
        or any(surface.unreadable for surface in outcome.surfaces)
    )
    if spoilt or outcome.kept or crashes or nothing:
        return UNREADABLE
    statuses = {run.quality for run in outcome.runs}
    statuses.update(*(surface.objections for surface in outcome.surfaces))
    if outcome.failed_models:
        statuses.add("fail")  # the same severity as in the findings
    return exit_code(statuses, outcome.campaign.qc.fail_on)
