"""What a results folder says of its campaign: settings, runs, files and their checksums."""

from __future__ import annotations

import datetime as dt
import functools
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.settings.config import Campaign
from tribolab.core.errors import ReadError, brief
from tribolab.core.untyped import Json

if TYPE_CHECKING:
    import pandas as pd

REPORT = "report.json"


@dataclass(frozen=True)
class Folder:
    """A results folder, its report read and its tables when asked for.

    Parameters
    ----------
    path
        The folder.
    report
        What its ``report.json`` says.
    """

    path: Path
    report: Json

    @property
    def name(self) -> str:
        """The folder as a reader knows it: that of the campaign if it is called as usual."""
        resolved = self.path.resolve()
        return resolved.parent.name if resolved.name == "results" else resolved.name

    @property
    def title(self) -> str:
        """Title of the campaign."""
        return str(self.report["campaign"]["name"])

    @functools.cached_property
    def campaign(self) -> Campaign | None:
        """The campaign file as it was; None where this version does not understand it."""
        return _campaign(self.report["campaign"]["text"])

    @property
    def made_at(self) -> dt.datetime:
        """When the results were made."""
        return dt.datetime.fromisoformat(self.report["made_at"])

    @property
    def done(self) -> list[Json]:
        """Runs that have results, as the report has them."""
        return [run for run in self.report["runs"] if run["status"] == "done"]

    @property
    def counting(self) -> set[str]:
        """Names of the runs that the measured curves are made of."""
        return {name for curve in self.report["curves"] for name in curve["runs"]}

    def checksums(self) -> dict[str, tuple[str, ...]]:
        """Return of each run the checksums of its raw files."""
        known = {source["file"]: source["sha256"] for source in self.report["sources"]}
        return {
            run["name"]: tuple(sorted(known.get(file, "") for file in run["files"]))
            for run in self.report["runs"]
        }

    def table(self, name: str) -> pd.DataFrame | None:
        """Return a table; None where the results have none of this name."""
        # late: starting stays quick
        from tribolab.report import tables

        path = self.path / "tables" / f"{name}.csv"
        return tables.read_csv(path) if path.is_file() else None


@functools.lru_cache(maxsize=8)
def _campaign(text: str) -> Campaign | None:
    """Read a campaign file; those of an archive are often the same."""
    try:
        return Campaign.model_validate(tomllib.loads(text), context={"in_file": True})
    except (ValueError, RecursionError):
        return None


def open_folder(path: str | Path) -> Folder:
    """Read the report of a results folder.

    Raises
    ------
    ReadError
        If it is none, or its report cannot be read.
    """
    path = Path(path)
    file = path / REPORT
    if not file.is_file():
        beside = path / "results" / REPORT
        if beside.is_file():
            return open_folder(path / "results")
        raise ReadError(
            f"{path}: no folder of results: it has no {REPORT}; name the folder that "
            "'tribolab run' wrote, e.g. results"
        )
    try:
        report: Json = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ReadError(f"{file}: the report cannot be read: {brief(error)}") from error
    wanted = ("campaign", "made_at", "runs", "curves", "sources", "versions")
    missing = [key for key in wanted if key not in report] if isinstance(report, dict) else wanted
    if missing:
        raise ReadError(f"{file}: no report of tribolab: it lacks {', '.join(missing)}")
    return Folder(path, report)
