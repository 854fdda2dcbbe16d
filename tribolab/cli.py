"""The command line. Commands import heavy modules only when run, so that --help is fast."""

from __future__ import annotations

from typing import Annotated

import typer

from tribolab.app.commands.across import compare, history, plan, repeatability
from tribolab.app.commands.campaign import figures, new, run
from tribolab.app.commands.files import check, dialect, info
from tribolab.app.commands.packing import pack, verify
from tribolab.app.commands.practice import demo, reproduce, simulate
from tribolab.app.reported import renamed
from tribolab.app.streams import prepared, say

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Friction experiments on soft, rough contacts: raw files in, friction coefficients with "
    "honest error bars and a report out.\n\n"
    "New here? `tribolab demo` simulates a campaign, analyses it and shows where to look.\n\n"
    "Exit codes: 0 success; 1 a finding at or above the campaign's fail_on; 2 usage error, or "
    "a mistake in the campaign or review file; 3 an input cannot be read, a check crashed, a "
    "decision applies to no run or segment, or nothing was found.",
)


def _version(asked: bool) -> None:
    if asked:
        # imported late: looks up the installed package
        from tribolab.version import __version__

        say(f"tribolab {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Accept the options that precede a command."""


lab = typer.Typer(
    no_args_is_help=True,
    help="Repeatability, control charts of an instrument, and planning of measurements.",
)
_LAB = (repeatability, history, plan)
_DAILY = (demo, new, run, check, info, compare, figures, pack, verify)
for _in_lab in _LAB:
    lab.command()(_in_lab)
    _name = _in_lab.__name__
    app.command(hidden=True)(renamed(_in_lab, _name, f"lab {_name}"))
for _daily in _DAILY:
    app.command()(_daily)
app.add_typer(lab, name="lab")
app.command(rich_help_panel="The reference paper and practice data")(reproduce)
app.command(rich_help_panel="The reference paper and practice data")(simulate)
app.command(hidden=True)(renamed(dialect, "dialect", "info FILE --write NAME.toml"))


def main() -> None:
    """Run the command line."""
    with prepared():
        app()
