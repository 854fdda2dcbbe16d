"""The review file: manual decisions on runs and segments, next to the campaign file."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tribolab.campaign.settings.fields import Si, SomeText
from tribolab.campaign.settings.problems import SettingsProblem, message
from tribolab.campaign.settings.toml_file import Opened, open_settings, settings_path
from tribolab.core.errors import TribolabError, nearest, shown
from tribolab.core.untyped import Json
from tribolab.friction.decisions.decision import Decision
from tribolab.reading.dialect.checked_text import NoSwitches

REVIEW_FILE = "review.toml"
REVIEW_SCHEMA_FILE = "review.schema.json"


class DecisionEntry(NoSwitches):
    """A manual decision on a run, or on the segment in a time interval of it."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    run: SomeText
    """Name of the run, as in the tables."""
    action: Literal["reject", "accept", "bounds", "note"]
    """Leave out; use despite a check; set new bounds of the segment; add a note."""
    start: Annotated[float, Si("s", "12.5 s")] | None = Field(default=None, alias="from")
    """Start of the interval; it selects the segment that contains more than half of it."""
    stop: Annotated[float, Si("s", "31 s")] | None = Field(default=None, alias="to")
    """End of the interval; without start and end the decision is on the whole run."""
    new_start: Annotated[float, Si("s", "14 s")] | None = Field(default=None, alias="new_from")
    """New start of the segment, before trimming, for "bounds"."""
    new_stop: Annotated[float, Si("s", "30 s")] | None = Field(default=None, alias="new_to")
    """New end of the segment, for "bounds"."""
    reason: SomeText
    """Reason for the decision."""
    author: SomeText
    """Author of the decision."""
    date: dt.date
    """Date of the decision."""

    @property
    def decision(self) -> Decision:
        """The decision without the name of the run."""
        return Decision(**self.model_dump(exclude={"run"}))

    @model_validator(mode="after")
    def _is_a_decision(self) -> Self:
        try:
            _ = self.decision
        except TribolabError as error:
            raise ValueError(error.message_for("campaign")) from error
        return self


class Review(BaseModel):
    """Manual decisions on the runs of a campaign."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    decision: tuple[DecisionEntry, ...] = ()
    """Decisions, in any order."""

    @property
    def by_run(self) -> dict[str, tuple[Decision, ...]]:
        """The decisions on each run."""
        runs: dict[str, tuple[Decision, ...]] = {}
        for entry in self.decision:
            runs[entry.run] = (*runs.get(entry.run, ()), entry.decision)
        return runs


def load_review(path: str | Path) -> dict[str, tuple[Decision, ...]]:
    r"""Read a review file.

    Parameters
    ----------
    path
        The TOML file, or the folder in which it is called ``review.toml``.

    Returns
    -------
    dict
        The decisions on each run, by its name, for `decide`.

    Raises
    ------
    ConfigError
        If anything in it is wrong: the message has the file, the line, the key and the cure.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "review.toml").write_text(
    ...         '[[decision]]\nrun = "sb-r_1"\naction = "reject"\nfrom = "12.5 s"\nto = "31 s"\n'
    ...         'reason = "slipped off"\nauthor = "A. Person"\ndate = 2026-11-20\n'
    ...     )
    ...     print(*load_review(folder)["sb-r_1"])
    reject, 12.5 to 31 s (A. Person, 2026-11-20)
    """
    missing = "write decisions in [[decision]] tables"
    return _opened(settings_path(path, REVIEW_FILE), missing).content.by_run


def load_entries(path: Path) -> tuple[DecisionEntry, ...]:
    """Return the decisions of a review file in their order."""
    return _opened(path).content.decision


def read_decisions(campaign_file: Path) -> dict[str, tuple[Decision, ...]]:
    """Return the decisions in the review file next to a campaign file, by run."""
    path = campaign_file.parent / REVIEW_FILE
    return load_review(path) if path.exists() else {}


def lost_decisions(campaign_file: Path, runs: Iterable[str]) -> tuple[str, ...]:
    """Return a message for each decision in the review file on a run that does not exist.

    Parameters
    ----------
    campaign_file
        The campaign file.
    runs
        Names of its runs.
    """
    path, known = campaign_file.parent / REVIEW_FILE, set(runs)
    if not path.exists():
        return ()
    file = _opened(path)
    lost = []
    for number, entry in enumerate(file.content.decision):
        if entry.run not in known:
            what = f"no run is called '{shown(entry.run)}'{nearest(entry.run, known)}"
            what += "; name the run as the tables do, or take the decision out"
            problem = SettingsProblem(("decision", number, "run"), what)
            lost.append(message([problem], Path(path.name), file.text))
    return tuple(lost)


def review_schema() -> Json:
    """Return the JSON Schema (2020-12) of the review file."""
    schema = Review.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def _opened(path: Path, missing: str = "") -> Opened[Review]:
    return open_settings(path, Review, "review", missing)
