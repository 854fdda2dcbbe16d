"""Contents of a results folder: settings, runs, tables, and checksums of raw files."""

from __future__ import annotations

import datetime as dt
import functools
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.moved_keys import move_keys
from tribolab.core.errors import AnalysisError, ReadError, brief
from tribolab.core.untyped import Json

if TYPE_CHECKING:
    import pandas as pd

REPORT = "report.json"


@dataclass(frozen=True)
class Folder:
    """Results folder, with its report, and tables that are read on demand.

    Parameters
    ----------
    path
        The folder.
    report
        Content of its ``report.json``.
    """

    path: Path
    report: Json

    @property
    def name(self) -> str:
        """Name of the folder; the campaign's name if the folder has the default name."""
        resolved = self.path.resolve()
        return resolved.parent.name if resolved.name == "results" else resolved.name

    @property
    def title(self) -> str:
        """Title of the campaign."""
        return str(self.report["campaign"]["name"])

    @functools.cached_property
    def campaign(self) -> Campaign | None:
        """Campaign file as it was at the analysis; None if this version cannot read it."""
        return _campaign(self.report["campaign"]["text"])

    @property
    def made_at(self) -> dt.datetime:
        """Time of the analysis."""
        return dt.datetime.fromisoformat(self.report["made_at"])

    @property
    def done(self) -> list[Json]:
        """Runs that have results, as listed in the report."""
        return [run for run in self.report["runs"] if run["status"] == "done"]

    @property
    def counting(self) -> set[str]:
        """Names of the runs that the measured curves include."""
        return {name for curve in self.report["curves"] for name in curve["runs"]}

    def checksums(self) -> dict[str, tuple[str, ...]]:
        """Return the checksums of the raw files, by run."""
        known = {source["file"]: source["sha256"] for source in self.report["sources"]}
        return {
            run["name"]: tuple(sorted(known.get(file, "") for file in run["files"]))
            for run in self.report["runs"]
        }

    @property
    def segments(self) -> list[Json]:
        """Segments of all runs with results: run, surface, medium, nominal load and friction."""
        labels = ("surface", "medium", "nominal_normal_force_N")
        return [
            {"run": run["name"], **{label: run[label] for label in labels}, **row}
            for run in self.done
            for row in run["segments"]
        ]

    def friction(self) -> pd.DataFrame:
        """Table of the friction of all segments.

        Raises
        ------
        AnalysisError
            If there are no segments.
        """
        # imported late: pandas loads slowly
        import pandas as pd

        if not (rows := self.segments):
            raise AnalysisError(f"{self.path}: there is no friction: it has no segments of runs")
        return pd.DataFrame(rows)

    def table(self, name: str) -> pd.DataFrame | None:
        """Return a table by its name; None if the folder does not contain it."""
        # imported late for a fast start
        from tribolab.report import tables

        path = self.path / "tables" / f"{name}.csv"
        return tables.read_csv(path) if path.is_file() else None


@functools.lru_cache(maxsize=8)
def _campaign(text: str) -> Campaign | None:
    """Return a campaign file, cached because the folders of an archive often repeat it."""
    try:
        content = tomllib.loads(text)
        move_keys(content)  # keys that were renamed since the last release
        return Campaign.model_validate(content, context={"in_file": True})
    except (ValueError, RecursionError):
        return None


def open_folder(path: str | Path) -> Folder:
    """Return a results folder, after reading its report.

    Raises
    ------
    ReadError
        If it is not a results folder, or its report cannot be read.
    """
    path = Path(path)
    file = path / REPORT
    if not file.is_file():
        report_file = path / "results" / REPORT
        if report_file.is_file():
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
