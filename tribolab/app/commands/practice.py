"""Commands on simulated and published data: the demo, the reference paper, practice campaigns."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.app.commands.campaign import show_outcome
from tribolab.app.progress import progress_bars
from tribolab.app.reported import Debug, Jobs, Quiet, leaving, reported
from tribolab.app.streams import say


def demo(
    folder: Annotated[
        Path, typer.Argument(help="Output folder; created if it does not exist.")
    ] = Path("tribolab-demo"),
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Simulate a campaign, analyse it and compare the result with the truth.

    The virtual rig measures the reference system: smooth and sandblasted PMMA cylinders on
    PDMS rubber, dry and in glycerol, at 13 speeds in repeats. If called again, it analyses the same
    raw files and repeats only changed parts.

        tribolab demo

        tribolab demo /tmp/look
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.demo import run_demo

        with progress_bars(quiet) as progress:
            outcome, compared = run_demo(folder, jobs=jobs, progress=progress)
        from tribolab.app.truth.lines import truth_lines  # after the workers have started

        code = show_outcome(outcome, debug)
        for line in truth_lines(compared, outcome):
            say(line)
    raise typer.Exit(code)


def reproduce(
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output folder; your own files in it are kept.")
    ] = Path("tribolab-paper"),
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Reproduce the figures of the reference paper, and compare its numbers with computed ones.

    `paper.html` shows, section by section, what was measured by the authors, computed here, or
    simulated by the virtual rig; `paper.csv` has a row for each of the 58 published numbers, with
    status and reason: inputs agree by construction and do not count as reproduced. It takes about a
    minute.

        tribolab reproduce --output /tmp/paper
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.truth.lines import paper_lines
        from tribolab.paper.reproduce import reproduce as reproduce_paper

        with progress_bars(quiet) as progress:
            made = reproduce_paper(output, jobs=jobs, progress=progress)
        say("\n".join(paper_lines(made.folder, made.table)))


def simulate(
    folder: Annotated[Path, typer.Argument(help="Output folder; must be new or empty.")],
    seed: Annotated[
        int, typer.Option(min=0, help="Seed of the random numbers; equal seeds give equal files.")
    ] = 0,
    repeats: Annotated[int, typer.Option(min=1, help="Runs per surface, medium and load.")] = 2,
    small: Annotated[
        bool, typer.Option("--small", help="Two surfaces, one load, three speeds.")
    ] = False,
    fault: Annotated[list[str] | None, leaving("--fault", "simulate faults in a notebook")] = None,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Write a simulated campaign of raw files from the virtual rig, with the truth.

    For learning, teaching, and testing an analysis on data with a known result.

        tribolab simulate practice --small

        tribolab run practice/campaign.toml
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.needed import SIMULATION
        from tribolab.campaign.engine.executor import workers
        from tribolab.rig import simulate_campaign

        pool_of = workers(jobs, modules=SIMULATION)
        with progress_bars(quiet) as progress, pool_of as pool:
            campaign = simulate_campaign(
                folder,
                seed,
                small=small,
                n_repeats=repeats,
                faults=fault or (),
                executor=pool,
                progress=progress,
            )
        say(f"{campaign} was written; analyse it with\n  tribolab run {campaign}")
