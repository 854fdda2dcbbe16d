"""The command line. Heavy imports wait in the commands, so that --help answers at once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.cli_words import progress_bar, reported, show_outcome, show_truth

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
        "mistake in the campaign file; 3 an input that cannot be read, or nothing found."
    ),
)

Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        "--jobs", "-j", min=1, help="Number of processes.", show_default="one per processor"
    ),
]


def _version(asked: bool) -> None:
    if asked:
        from tribolab import __version__

        typer.echo(f"tribolab {__version__}")
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

    The virtual rig measures the reference system: a PMMA cylinder on smooth and sandblasted
    PDMS, dry and in glycerol, at 13 speeds in repeats. Called again, it analyses the same raw
    files and redoes only what changed.

        tribolab demo

        tribolab demo /tmp/look
    """
    with reported(debug):
        from tribolab.campaign.executor import default_jobs
        from tribolab.report.run import run_campaign
        from tribolab.report.truth import compare_with_truth
        from tribolab.rig import simulate_campaign

        campaign = folder / "campaign.toml"
        compared = []
        with progress_bar(quiet) as progress:
            if not (campaign.is_file() and (folder / "truth" / "truth.json").is_file()):
                simulate_campaign(folder, jobs=jobs or default_jobs(), progress=progress)
            outcome = run_campaign(
                campaign,
                jobs=jobs,
                progress=progress,
                finish=lambda outcome: compared.append(compare_with_truth(outcome, folder)),
            )
        code = show_outcome(outcome)
        show_truth(compared[0], folder, outcome)
    raise typer.Exit(code)


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
            help="Folder of the results; replaced as a whole.",
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
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Analyse a campaign: friction of every run, measured curves, report.

    Raw files are only read. Results appear whole or not at all, and what did not change since
    the last time is not done again.

        tribolab run campaign.toml

        tribolab run campaign.toml --output /tmp/results --jobs 4
    """
    with reported(debug):
        from tribolab.report.run import run_campaign

        with progress_bar(quiet) as progress:
            outcome = run_campaign(
                campaign, output=output, jobs=jobs, scheduler=scheduler, progress=progress
            )
        code = show_outcome(outcome)
    raise typer.Exit(code)


@app.command()
def simulate(
    folder: Annotated[Path, typer.Argument(help="Where to; must be new or empty.")],
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same files.")] = 0,
    repeats: Annotated[int, typer.Option(min=1, help="Runs per surface, medium and load.")] = 2,
    small: Annotated[
        bool, typer.Option("--small", help="Two surfaces, one load, three speeds.")
    ] = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Write a campaign of raw files as the virtual rig measures it, with the truth beside it.

    To learn with, to teach with, and to try an analysis on data whose answer is known.

        tribolab simulate practice --small

        tribolab run practice/campaign.toml
    """
    with reported(debug):
        from tribolab.campaign.executor import default_jobs
        from tribolab.rig import simulate_campaign

        with progress_bar(quiet) as progress:
            campaign = simulate_campaign(
                folder,
                seed,
                small=small,
                n_repeats=repeats,
                jobs=jobs or default_jobs(),
                progress=progress,
            )
        typer.echo(f"{campaign} is written; analyse it with\n  tribolab run {campaign}")


@app.command()
def info(
    files: Annotated[list[Path], typer.Argument(help="Raw files.")],
    instrument: Annotated[
        str | None,
        typer.Option(
            "--instrument",
            "-i",
            help="Name of an instrument, or the .toml file that describes it.",
            show_default="the files tell",
        ),
    ] = None,
    debug: Debug = False,
) -> None:
    """Show how raw files are understood, before anything is computed.

        tribolab info raw/friction/*.csv

        tribolab info odd.txt --instrument my_tribometer.toml
    """
    with reported(debug):
        from tribolab.cli_words import show_files

        code = show_files(files, instrument)
    raise typer.Exit(code)


def main() -> None:
    """Run the command line."""
    app()
