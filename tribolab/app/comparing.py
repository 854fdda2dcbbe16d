"""The commands that set results beside each other."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tribolab.app.reported import Debug, reported
from tribolab.app.streams import say


def compare(
    folders: Annotated[
        list[Path], typer.Argument(help="Results folders; each is compared with the first.")
    ],
    by: Annotated[
        str,
        typer.Option(
            help="Compare two parts of one folder: surface or medium, the first two or those of "
            "--level; with several folders, what they differ in on purpose."
        ),
    ] = "",
    level: Annotated[
        list[str] | None,
        typer.Option(help="With --by: which; given twice.", show_default=False),
    ] = None,
    margin: Annotated[
        str,
        typer.Option(help='Largest difference that does not matter: "5 %" or "0.01".'),
    ] = "",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the page and its tables.")
    ] = Path("comparison"),
    debug: Debug = False,
) -> None:
    """Compare campaigns, or surfaces and media within one: what differs, and how surely.

    What changed in settings, code and data; the difference of every curve at every speed with an
    error rate of 5 % for all of them together; shear stresses and roughness.

        tribolab compare march/results june/results

        tribolab compare results --by surface --margin "5 %"
    """
    with reported(debug):
        from tribolab.across.compare import compare as compared_with
        from tribolab.across.compare_page import verdict_text, write_comparisons
        from tribolab.errors import ConfigError

        if len(folders) == 1 and not by:
            raise ConfigError("one folder is compared with nothing: name another, or say --by")
        others: list[Path | None] = [*folders[1:]] or [None]
        made = [
            compared_with(
                folders[0],
                other,
                by=by,
                levels=tuple(level or ()),
                margin=margin,
                pairs=len(others),
            )
            for other in others
        ]
        page = write_comparisons(made, output)
        for pair in made:
            for change in pair.changes:
                say(f"{change.kind}: {change.what}: {change.first} → {change.second}")
            say(verdict_text(pair))
        say(f"page: {page}")


def repeatability(
    campaign: Annotated[
        Path, typer.Argument(help="The campaign file, its folder, or a results folder.")
    ],
    by: Annotated[
        str,
        typer.Option(
            help="What may make runs differ, parted by commas: mount, day, operator, specimen or "
            "labels of the campaign file; day:mount for mounts that are new every day."
        ),
    ] = "mount",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the page and its tables.")
    ] = Path("repeatability"),
    debug: Debug = False,
) -> None:
    """Tell how well a coefficient repeats: within a mount, between mounts, days, operators.

    Components of variance at each speed and pooled, with the limits r and R of ISO 5725. The
    campaign file says in its runs who measured them, when, and on which mount.

        tribolab repeatability campaign.toml --by mount,day,operator
    """
    with reported(debug, audience="campaign"):
        from tribolab.across.repeatability import repeatability as repeated
        from tribolab.across.repeatability import verdict_text
        from tribolab.across.repeatability_page import write_repeatability

        told = repeated(campaign, by)
        name = campaign.resolve().parent.name if campaign.is_file() else campaign.resolve().name
        page = write_repeatability(told, f"Repeatability of {name}", output)
        say(verdict_text(told))
        say(f"page: {page}")
