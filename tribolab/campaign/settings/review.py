"""The review file: what a person decided on runs and segments, beside the campaign file."""

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
from tribolab.reading.dialect.switches import NoSwitches

REVIEW_FILE = "review.toml"
REVIEW_SCHEMA_FILE = "review.schema.json"


class DecisionEntry(NoSwitches):
    """One decision on a run, or on the segment in an interval of its time."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    run: SomeText
    """Name of the run, as in the tables."""
    action: Literal["reject", "accept", "bounds", "note"]
    """Leave it out; use it in spite of a check; bound the segment anew; only remark something."""
    start: Annotated[float, Si("s", "12.5 s")] | None = Field(default=None, alias="from")
    """Where the interval begins; the segment that holds more than half of it is meant."""
    stop: Annotated[float, Si("s", "31 s")] | None = Field(default=None, alias="to")
    """Where it ends; without both the whole run is meant."""
    new_start: Annotated[float, Si("s", "14 s")] | None = Field(default=None, alias="new_from")
    """Where the segment begins now, for "bounds"; it is trimmed from there."""
    new_stop: Annotated[float, Si("s", "30 s")] | None = Field(default=None, alias="new_to")
    """Where it ends now."""
    reason: SomeText
    """Why."""
    author: SomeText
    """Who decided."""
    date: dt.date
    """When."""

    @property
    def decision(self) -> Decision:
        """What is decided, without the run."""
        return Decision(**self.model_dump(exclude={"run"}))

    @model_validator(mode="after")
    def _is_a_decision(self) -> Self:
        try:
            _ = self.decision
        except TribolabError as error:
            raise ValueError(error.told("campaign")) from error
        return self


class Review(BaseModel):
    """What a person decided on the runs of a campaign."""

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
    missing = "decisions stand in [[decision]] tables"
    return _opened(settings_path(path, REVIEW_FILE), missing).content.by_run


def load_entries(path: Path) -> tuple[DecisionEntry, ...]:
    """Return the decisions of a review file in their order."""
    return _opened(path).content.decision


def review_beside(campaign_file: Path) -> dict[str, tuple[Decision, ...]]:
    """Return the decisions that lie beside a campaign file, by run; none without such a file."""
    path = campaign_file.parent / REVIEW_FILE
    return load_review(path) if path.exists() else {}


def lost_decisions(campaign_file: Path, runs: Iterable[str]) -> tuple[str, ...]:
    """Say which decisions beside a campaign file are on a run that there is not.

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
