"""Remedies for errors about raw files, in words for each audience (see `Cure`)."""

from __future__ import annotations

import shlex
from pathlib import Path

from tribolab.core.errors import Cure

RUN, SURFACE = "[[run]]", "[[surface]]"


def name_instrument(table: str = "", say: str = "say which with") -> Cure:
    """Return the remedy "name the instrument of the file".

    Parameters
    ----------
    table
        Table of a campaign file in which the file is named; if unknown, both are mentioned.
    say
        Words before the option.

    Examples
    --------
    >>> name_instrument(RUN).terminal, name_instrument(RUN).campaign
    ('say which with --instrument', 'say which with instrument = "..." in its [[run]]')
    """
    place = table or f"{RUN} or {SURFACE}"
    return Cure(
        notebook=f"{say} instrument=",
        terminal=f"{say} --instrument",
        campaign=f'{say} instrument = "..." in its {place}',
    )


def unknown_instrument(path: Path, table: str) -> Cure:
    """Return the remedy "draft a dialect, and name it" for a file of an unknown instrument."""
    command = "'tribolab info {} --write my.toml' drafts a description of it"
    name = name_instrument(table, say="name it with")
    bare = shlex.quote(path.name)
    return Cure(
        notebook=f"{command.format(bare)}: {name.notebook}",
        terminal=f"{command.format(shlex.quote(str(path)))}: {name.terminal}",
        campaign=f"{command.format(bare)}: {name.campaign}",
    )


PROFILE = Cure(
    notebook="read it with read_scans()",
    terminal="'tribolab check' takes it, a campaign under scans of a [[surface]]",
    campaign="it belongs under scans of a [[surface]]",
)
PERHAPS_PROFILE = Cure(
    notebook="if it holds a profile or map of heights, read it with read_scans()",
    terminal="if it holds a profile or map of heights, try 'tribolab check'",
    campaign="if it holds a profile or map of heights, it belongs under scans of a [[surface]]",
)


def either(first: str, other: Cure) -> Cure:
    """Return two alternative remedies as one; the first has the same words for all audiences."""
    return Cure(
        *(f"{first}, or {other.message_for(who)}" for who in ("notebook", "terminal", "campaign"))
    )


def joined(first: Cure, second: Cure) -> Cure:
    """Return two remedies as one, separated by a semicolon."""
    return Cure(
        *(
            f"{first.message_for(audience)}; {second.message_for(audience)}"
            for audience in ("notebook", "terminal", "campaign")
        )
    )


MODULUS = Cure(
    notebook="tribolab.rubber.read_modulus() reads it",
    terminal="name it as modulus_file in [contact] of a campaign file",
    campaign="name it as modulus_file in [contact]",
)
MEND_SIGNALS = Cure(
    notebook="read it with read()",
    terminal="a campaign takes it as a [[run]]",
    campaign="it belongs in a [[run]]",
)
TESTER_RESULTS = Cure(
    notebook="read_tester_results() of tribolab.reading.scans.results reads them",
    terminal="'tribolab check' takes them",
    campaign="'tribolab check' takes them; the scans of a [[surface]] are profiles",
)
NAME_COLUMNS = "write names and units above the columns: 'x [mm];z [um]' or 'time [s];force [N]'"
MEND_UNITS = Cure(
    notebook="say them with x_unit= and height_unit=, e.g. x_unit='mm', height_unit='um', or name "
    "the dialect that says them with instrument=",
    terminal="name the dialect that says them with --instrument",
    campaign=f'name the dialect that says them with instrument = "..." in its {SURFACE}',
)
SIZE = Cure(
    notebook="say its unit with x_unit=, or name the dialect that says it with instrument=",
    terminal="name the dialect that says it with --instrument",
    campaign=f'name the dialect that says it with instrument = "..." in its {SURFACE}',
)
