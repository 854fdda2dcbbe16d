"""Commands that pack results for others, and verify results and archives."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.app.progress import progress_bars
from tribolab.app.reported import UNREADABLE, Debug, Jobs, Quiet, reported
from tribolab.app.streams import say
from tribolab.core.errors import ConfigError

_MAX_NAMED = 50  # most files named


def pack(
    results: Annotated[Path, typer.Argument(help="The results folder.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="The .zip file.",
            show_default="the campaign's title, next to the results",
        ),
    ] = None,
    raw: Annotated[
        bool, typer.Option("--raw", help="Include the raw files, not only their checksums.")
    ] = False,
    campaign: Annotated[
        Path | None, typer.Option(help="The campaign file.", show_default="next to the results")
    ] = None,
    author: Annotated[str, typer.Option(help="Name of the author.")] = "",
    publisher: Annotated[str, typer.Option(help="Address or DOI of the publication.")] = "",
    licence: Annotated[str, typer.Option(help="SPDX name of the licence, e.g. CC-BY-4.0.")] = "",
    debug: Debug = False,
) -> None:
    """Pack results into one file for a repository, which others can read and analyse again.

    Writes an RO-Crate with report, tables, data and settings, with description and SHA-256 of every
    file. All bytes of the results are verified first, and the archive before it gets its name.

        tribolab pack results --raw --author "A. Person" --licence CC-BY-4.0
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.archive import packing

        if results.is_file():
            raise ConfigError(
                f"{results}: this is a file, not a results folder; 'tribolab verify {results}' "
                "checks a packed file"
            )
        made = packing.pack(
            results,
            output,
            raw=raw,
            campaign=campaign,
            author=author,
            publisher=publisher,
            licence=licence,
        )
        say(f"packed and checked: {made}")
        if not licence:
            say(
                "no licence is stated, so others may not reuse the data; state --licence, e.g. "
                "CC-BY-4.0"
            )


def verify(
    results: Annotated[Path, typer.Argument(help="The results folder, or a packed .zip file.")],
    recompute: Annotated[
        bool,
        typer.Option(
            "--recompute", help="Compute all numbers again from the raw files, and compare."
        ),
    ] = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Restore a lost .tribolab-results file.")
    ] = False,
    campaign: Annotated[
        Path | None, typer.Option(help="The campaign file.", show_default="next to the results")
    ] = None,
    trust: Annotated[
        bool,
        typer.Option("--trust", help="Allow the Python readers named in the campaign file to run."),
    ] = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Check that no byte of the results has changed since they were written.

    Checksums reveal damage: a flipped bit, an incomplete file, a manual change. They have no key,
    so a forged table can have a matching checksum. Only --recompute reveals that: it computes
    tables, report.json and data files again from the raw files and compares the numbers.

        tribolab verify results

        tribolab verify results --recompute

        tribolab verify deposit.zip
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.verifying import mend, problems, recomputed

        if results.is_file() and (recompute or repair):
            raise ConfigError(
                f"{results}: --recompute and --repair are for a results folder; unpack it first"
            )
        if repair:
            mend(results)
            say(
                f"{results}: .tribolab-results is restored; 'tribolab run' now computes "
                "everything again and keeps copies of the present tables and page"
            )
            return
        wrong = problems(results)
        if recompute:
            with progress_bars(quiet) as progress:
                wrong += recomputed(results, campaign, jobs=jobs, progress=progress, trust=trust)
        for text in wrong[:_MAX_NAMED]:
            say(f"tribolab: {results}: {text}", to_stderr=True)
        if len(wrong) > _MAX_NAMED:
            say(f"tribolab: {results}: and {len(wrong) - _MAX_NAMED} more", to_stderr=True)
        if wrong:
            raise typer.Exit(UNREADABLE)
        verb = "packed" if results.is_file() else "written"
        same = ", and recomputing from the raw files gives the same results" if recompute else ""
        say(f"{results}: unchanged since it was {verb}{same}")
