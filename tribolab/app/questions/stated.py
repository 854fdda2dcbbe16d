"""Amounts stated on the command line for raw files: load, radius, speed, rate."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from tribolab.app.questions.typed import amount_typed, turning
from tribolab.core.errors import ConfigError, TribolabError
from tribolab.units.conversion import to_si

LoadOption = Annotated[
    str | None,
    typer.Option("--load", help="Normal force, if the files do not state it: 20N.", metavar="N"),
]
RadiusOption = Annotated[
    str | None, typer.Option("--radius", help="Radius of the wear track: 15mm.", metavar="LENGTH")
]
SpeedOption = Annotated[
    str | None,
    typer.Option("--speed", help="Sliding speed: 10mm/s; 60rpm with --radius.", metavar="SPEED"),
]
RateOption = Annotated[
    str | None, typer.Option("--rate", help="Sampling rate: 100Hz.", metavar="HZ")
]


class Stated(NamedTuple):
    """Amounts stated on the command line, as numbers with a unit; None if not stated."""

    load: str | None = None
    radius: str | None = None
    speed: str | None = None
    rate: str | None = None

    @classmethod
    def of(
        cls, load: str | None, radius: str | None, speed: str | None, rate: str | None
    ) -> Stated:
        """Return the amounts stated by options, each as a number with a unit.

        Raises
        ------
        ConfigError
            If an option is not a valid amount.
        """
        if speed is not None and radius is not None:
            speed = turning(f"{_spaced(speed)} at {_spaced(radius)} radius") or speed
        given = cls(load, radius, speed, rate)
        stated = {}
        for name, unit in _UNITS.items():
            value = getattr(given, name)
            if value is None:
                continue
            try:
                stated[name] = amount_typed(_spaced(value), name, unit)
            except TribolabError as error:
                hint = ". State --radius, too" if name == "speed" and radius is None else ""
                raise ConfigError(f"--{name}: {error.what}{hint}") from error
        return cls(**stated)

    @property
    def is_empty(self) -> bool:
        """Whether no amount is stated."""
        return all(value is None for value in self)

    def run_lines(self, *, described: bool) -> list[str]:
        """Return the lines of a [[run]] with load and speed; no speed if the description has it."""
        values = {"normal_force": self.load, "sliding_speed": None if described else self.speed}
        return [f'{key} = "{value}"' for key, value in values.items() if value is not None]


_UNITS = {"load": "N", "radius": "m", "speed": "m/s", "rate": "Hz"}


def _spaced(text: str) -> str:
    """Return a number and its unit with a space between them.

    >>> _spaced("20N"), _spaced("1.5e3 mm/s")
    ('20 N', '1.5e3 mm/s')
    """
    text = text.strip()
    for place in range(len(text), 0, -1):
        try:
            to_si(text[:place], "1", name="")
        except TribolabError:
            continue
        return f"{text[:place].strip()} {text[place:].strip()}"
    return text


def describe_with(stated: Stated, files: Sequence[Path], folder: Path | None = None) -> str | None:
    """Write a description of an unknown instrument with the amounts from the command line.

    Parameters
    ----------
    stated
        Amounts from the command line.
    files
        Raw files; the instrument of the first unknown one is described.
    folder
        Folder for the description ``instrument_NAME.toml``; by default a temporary folder.

    Returns
    -------
    str or None
        The description; None if all instruments are known, or no amount is stated.
    """
    if stated.is_empty:
        return None
    # imported late for a quick start
    from tribolab.campaign.settings.naming.run_names import safe_name
    from tribolab.reading.kinds import kind_of
    from tribolab.reading.unknown.proposal.draft import save_draft
    from tribolab.reading.unknown_run import draft_of

    for file in files:
        if kind_of(file) != "unknown":
            continue
        draft = draft_of(file)
        if draft is None or draft.kind != "run" or draft.understood is None:
            continue
        values = {name: value for name, value in stated._asdict().items() if value is not None}
        draft = draft.with_understood(draft.understood._replace(**values))
        if draft.dialect is None:
            return None
        place = folder
        if place is None:
            place = Path(tempfile.mkdtemp(prefix="tribolab-"))
            atexit.register(shutil.rmtree, place, ignore_errors=True)
        return str(save_draft(draft, place / f"instrument_{safe_name(file.stem)}.toml", force=True))
    return None
