"""The command line. Heavy imports wait in the commands, so that --help answers at once."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tribolab.app.comparing import compare, history, plan, repeatability
from tribolab.app.packing import pack
from tribolab.app.progress import progress_bars
from tribolab.app.reported import UNREADABLE, Debug, Jobs, Quiet, fail, reported
from tribolab.app.streams import prepared, say

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from tribolab.campaign.store.outcome import Outcome

_MANY = 12  # files, from which on it pays to start other processes

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help=(
        "Friction experiments on soft, rough contacts: raw files in, friction coefficients with "
        "honest error bars and a report out.\n\n"
        "New here? `tribolab demo` simulates a campaign, analyses it and shows where to look.\n\n"
        "Exit codes: 0 fine; 1 a finding at or above the campaign's fail_on; 2 wrong use or a "
        "mistake in the campaign or review file; 3 an input that cannot be read, a decision that "
        "finds nothing to decide on, or nothing found."
    ),
)

Instrument = Annotated[
    str | None,
    typer.Option(
        "--instrument",
        "-i",
        help="Name of an instrument, or the .toml file that describes it.",
        show_default="the files tell",
    ),
]


def _version(asked: bool) -> None:
    if asked:
        from tribolab.version import __version__

        say(f"tribolab {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Take the options that stand before a command."""


@app.command()
def demo(
    folder: Annotated[
        Path, typer.Argument(help="Where to put it; made if it is not there.")
    ] = Path("tribolab-demo"),
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Simulate a campaign, analyse it and compare the result with the truth.

    The virtual rig measures the reference system: smooth and sandblasted PMMA cylinders on
    PDMS rubber, dry and in glycerol, at 13 speeds in repeats. Called again, it analyses the same
    raw files and redoes only what changed.

        tribolab demo

        tribolab demo /tmp/look
    """
    with reported(debug):
        from tribolab.app.demo import run_demo
        from tribolab.app.terminal import truth_lines

        with progress_bars(quiet) as progress:
            outcome, compared = run_demo(folder, jobs=jobs, progress=progress)
        code = show_outcome(outcome, debug)
        for line in truth_lines(compared, outcome):
            say(line)
    raise typer.Exit(code)


@app.command()
def reproduce(
    output: Annotated[
        Path,
        typer.Option("--output", "-o", help="Folder of the results; files of yours in it stay."),
    ] = Path("tribolab-paper"),
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Reproduce the reference paper: its figures, and its numbers beside computed ones.

    `paper.html` goes through it section by section and says what was measured by the authors, what
    is computed here and what is simulated by the virtual rig; `paper.csv` has a row for each of
    the 58 published numbers, with status and reason: what was put in agrees by construction and is
    not counted as reproduced. It takes about a minute.

        tribolab reproduce --output /tmp/paper
    """
    with reported(debug):
        from tribolab.app.terminal import paper_lines
        from tribolab.paper.reproduce import reproduce as reproduce_paper

        with progress_bars(quiet) as progress:
            made = reproduce_paper(output, jobs=jobs, progress=progress)
        say("\n".join(paper_lines(made.folder, made.table)))


@app.command()
def run(
    campaign: Annotated[
        Path, typer.Argument(help="The campaign file (TOML), or the folder with campaign.toml.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Folder of the results; files of yours in it stay.",
            show_default="as the campaign file says, else results/ beside it",
        ),
    ] = None,
    jobs: Jobs = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            help="Address of a Dask scheduler to work on, e.g. tcp://10.0.0.5:8786.",
            show_default=False,
        ),
    ] = None,
    figures: Annotated[
        str,
        typer.Option(help="Figures for publication: all, curves (measured curves only) or none."),
    ] = "all",
    pdf: Annotated[bool, typer.Option("--pdf", help="Write figures as PDF, too.")] = False,
    verify: Annotated[
        bool,
        typer.Option(
            "--verify", help="Read every file to tell what changed, not its size and time only."
        ),
    ] = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Analyse a campaign: friction of every run, measured curves, report.

    Raw files are only read. Results appear whole or not at all, and what did not change since
    the last time is not done again.

        tribolab run campaign.toml

        tribolab run campaign.toml --output /tmp/results --jobs 4
    """
    with reported(debug, audience="campaign"):
        from tribolab.app.run import run_campaign

        with progress_bars(quiet) as progress:
            outcome = run_campaign(
                campaign,
                output=output,
                jobs=jobs,
                scheduler=scheduler,
                progress=progress,
                figures=figures,
                pdf=pdf,
                verify=verify,
            )
        code = show_outcome(outcome, debug)
    raise typer.Exit(code)


@app.command()
def simulate(
    folder: Annotated[Path, typer.Argument(help="Where to; must be new or empty.")],
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same files.")] = 0,
    repeats: Annotated[int, typer.Option(min=1, help="Runs per surface, medium and load.")] = 2,
    small: Annotated[
        bool, typer.Option("--small", help="Two surfaces, one load, three speeds.")
    ] = False,
    fault: Annotated[
        list[str] | None,
        typer.Option(
            help="Put this fault into one run, or into the scans of one surface (dropouts and "
            "saturation: of a run, with scan_ before them of scans); may be given again. A wrong "
            "name lists them.",
            show_default=False,
        ),
    ] = None,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Write a campaign of raw files as the virtual rig measures it, with the truth beside it.

    To learn with, to teach with, and to try an analysis on data whose answer is known.

        tribolab simulate practice --small

        tribolab run practice/campaign.toml

        tribolab simulate faulty --small --fault spikes --fault sign
    """
    with reported(debug):
        from tribolab.campaign.engine.executor import workers
        from tribolab.rig import simulate_campaign

        with progress_bars(quiet) as progress, workers(jobs) as pool:
            campaign = simulate_campaign(
                folder,
                seed,
                small=small,
                n_repeats=repeats,
                faults=fault or (),
                executor=pool,
                progress=progress,
            )
        say(f"{campaign} is written; analyse it with\n  tribolab run {campaign}")


@app.command()
def check(
    files: Annotated[
        list[Path], typer.Argument(help="Runs (the two logs of one are one run) and scans.")
    ],
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
    fail_on: Annotated[
        str, typer.Option(help="Exit with 1 from which status on: suspect, fail or never.")
    ] = "fail",
    instrument: Instrument = None,
    repeats: Annotated[
        bool | None,
        typer.Option(help="Compare scans as repeats.", show_default="by names but the last number"),
    ] = None,
    notes: Annotated[bool, typer.Option("--notes", help="Show notes on sound files.")] = False,
    everything: Annotated[bool, typer.Option("--all", help="Show what passed, too.")] = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Say whether runs and scans are usable, while the sample is still mounted.

    What is wrong, where, how badly, and what to do. Nothing is written.

        tribolab check raw/friction/sb-r_dry_31N_01_*.csv

        tribolab check raw/profiles/*.csv --json --fail-on suspect
    """
    with reported(debug):
        from tribolab.app.quick import importing, plain_arrays_only

        with importing():
            plain_arrays_only()
            from tribolab.app import checks

        code = checks.code_of([], fail_on)  # a wrong level is told before the work
        with progress_bars(quiet) as progress, _pool(jobs, files) as pool:
            checked = checks.check_files(
                files, instrument, repeats=repeats, executor=pool, progress=progress
            )
        code = checks.code_of(checked, fail_on)
        if as_json:
            say(checks.as_json(checked, fail_on))
        else:
            checks.show(checked, notes=notes, everything=everything)
    raise typer.Exit(code)


@app.command()
def info(
    files: Annotated[list[Path], typer.Argument(help="Raw files.")],
    instrument: Instrument = None,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Show how raw files are understood, before anything is computed.

    tribolab info raw/friction/*.csv

    tribolab info odd.txt --instrument my_tribometer.toml
    """
    with reported(debug):
        from tribolab.app.quick import importing, plain_arrays_only

        with importing():
            plain_arrays_only()
            from tribolab.app.file_info import Descriptions
            from tribolab.campaign.engine.stage import perform

        with progress_bars(quiet) as progress, _pool(jobs, files) as pool:
            described = perform(Descriptions(files, instrument), pool, progress)
        for description in described:
            if description.error:
                say(f"tribolab: {description.error}", to_stderr=True)
            else:
                say("\n".join(description.lines))
    raise typer.Exit(UNREADABLE if any(description.error for description in described) else 0)


@app.command()
def dialect(
    files: Annotated[
        list[Path], typer.Argument(help="Raw text files of one instrument that is not known yet.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="The .toml file to write.",
            show_default="the dialect's name, in this folder",
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Option(
            help="Name of the dialect: small letters, digits, _.",
            show_default="from the file's name",
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the .toml file if there is one.")
    ] = False,
    ask: Annotated[
        bool | None,
        typer.Option(
            "--ask/--no-ask",
            help="Ask which column is what; Enter takes the guess.",
            show_default="in a terminal",
        ),
    ] = None,
    debug: Debug = False,
) -> None:
    """Draft the description of an unknown instrument's files from one or several of them.

    Shows the file as it was understood and what was guessed, asks about it in a terminal, writes
    the description (TOML), tries it on the files, and says which of its lines want to be filled
    in. What is not in all of the files is optional. The raw files are only read.

        tribolab dialect odd.txt

        tribolab dialect raw/*.csv --output instruments/my_tribometer.toml
    """
    with reported(debug):
        from tribolab.app.dialect import ask_about, try_on
        from tribolab.app.terminal import console
        from tribolab.draft.dialect.draft import check_target, save_draft
        from tribolab.draft.dialect.examples import draft_of_examples
        from tribolab.draft.dialect.show import print_draft, print_next, print_signals

        draft = draft_of_examples(files, name)
        target = output or Path(f"{draft.name}.toml")
        print_draft(draft, console())
        if draft.toml:
            check_target(target, force=force)
        if ask or (ask is None and sys.stdin.isatty() and sys.stdout.isatty()):
            before = draft
            draft = ask_about(draft, _prompt, say)
            if draft is not before:
                print_signals(draft, console())
        if not draft.toml:
            fail(f"{files[0]}: no dialect is written: {draft.answer}", UNREADABLE, debug=False)
        written = save_draft(draft, target, force=force)
        for line in try_on(files, written, draft.kind):
            say(line)
        print_next(draft, written, console())


for _command in (compare, repeatability, history, plan, pack):
    app.command()(_command)


def _prompt(question: str, default: str) -> str:
    return str(typer.prompt(question, default=default))


def _pool(
    jobs: int | None, files: Sequence[Path]
) -> contextlib.AbstractContextManager[Executor | None]:
    """Return processes to look at files in; a few files are looked at here, which is sooner."""
    from tribolab.campaign.engine.executor import workers

    return workers(1 if jobs is None and len(files) < _MANY else jobs)


def show_outcome(outcome: Outcome, debug: bool) -> int:
    """Show what a campaign came to, with the tracebacks of crashes if `debug`; return exit code."""
    from tribolab.app import terminal
    from tribolab.qc.findings import exit_code

    table = terminal.outcome_table(outcome)
    if table.row_count:
        terminal.console().print(table)
    for line in terminal.outcome_lines(outcome):
        say(line)
    for line in terminal.foreign_lines(outcome):
        say(line)
    for line in terminal.failure_lines(outcome):
        say(f"tribolab: {line}", to_stderr=True)
    crashes = [curve.crash for curve in outcome.curves if curve.crash]
    for crash in crashes if debug else ():
        say(crash, to_stderr=True)
    nothing = bool(outcome.campaign.run) and not outcome.segments
    if nothing:
        say("tribolab: no segment of constant speed was found in any run", to_stderr=True)
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
        statuses.add("fail")  # as the findings call it
    return exit_code(statuses, outcome.campaign.qc.fail_on)


def main() -> None:
    """Run the command line."""
    with prepared():
        app()
