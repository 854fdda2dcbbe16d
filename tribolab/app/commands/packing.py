"""The command that packs results for others, and checks what was packed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.app.reported import UNREADABLE, Debug, reported
from tribolab.app.streams import say


def pack(
    results: Annotated[
        Path, typer.Argument(help="The results folder; or a packed file, which is checked.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", help="The .zip file.", show_default="the campaign's title, beside"
        ),
    ] = None,
    raw: Annotated[
        bool, typer.Option("--raw", help="Take raw files along, not their checksums only.")
    ] = False,
    campaign: Annotated[
        Path | None,
        typer.Option(help="The campaign file.", show_default="beside the results"),
    ] = None,
    author: Annotated[str, typer.Option(help="Who deposits.")] = "",
    publisher: Annotated[str, typer.Option(help="Where it is published.")] = "",
    licence: Annotated[str, typer.Option(help="Its SPDX name, e.g. CC-BY-4.0.")] = "",
    debug: Debug = False,
) -> None:
    """Pack results for a repository: one file that others can read and run again.

    An RO-Crate with report, tables, data and settings, every file with description and SHA-256,
    checked before it gets its name. Given a packed file, says what is not as it was packed.

        tribolab pack results --raw --author "A. Person" --licence CC-BY-4.0

        tribolab pack deposit.zip
    """
    with reported(debug):
        # late: starting stays quick
        from tribolab.deposit import pack as packing

        if results.is_file():
            wrong = packing.problems_of(results)
            for text in wrong:
                say(f"tribolab: {results}: {text}", to_stderr=True)
            if wrong:
                raise typer.Exit(UNREADABLE)
            say(f"{results}: as it was packed")
            return
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
            say("no licence is stated: others may only ask; say --licence, e.g. CC-BY-4.0")
