"""Labels of runs: operator, mount, day, specimen, and those that the user adds.

Labels affect no result: they are read on demand, and adding one to the campaign file does not
repeat the analysis.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

import pandas as pd

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.measured import RunEntry
from tribolab.campaign.settings.name_pattern import NamePattern
from tribolab.campaign.settings.naming.named import is_named
from tribolab.comparison.folder import Folder, open_folder


def labelled_segments(place: str | Path) -> pd.DataFrame:
    """Return the friction of all segments of a campaign, with the labels of their runs.

    Parameters
    ----------
    place
        A campaign file, its folder, or a results folder. With a campaign file its current
        labels are used.

    Raises
    ------
    ConfigError, ReadError
        If it cannot be read, or there are no results yet.
    AnalysisError
        If the results have no runs.
    """
    path = Path(place)
    campaign: Campaign | None = None
    if path.is_file() or (path / "campaign.toml").is_file():
        # imported late for a fast start
        from tribolab.campaign.settings.load import load_campaign

        campaign = load_campaign(path)
        folder = open_folder(campaign.output)
    else:
        folder = open_folder(path)
        campaign = folder.campaign
    table = folder.friction()
    labels = labels_of_runs(folder, campaign)
    new = labels.columns.difference(table.columns)
    return table.join(labels[new], on="run")


def labels_of_runs(folder: Folder, campaign: Campaign | None) -> pd.DataFrame:
    """Return the labels of the runs in a results folder, by run."""
    rows = {}
    for run in folder.done:
        entry = _entry_of(campaign, run) if campaign is not None else None
        named = campaign.campaign.files_named if campaign is not None else None
        own = _entry_labels(entry, run["files"][0], named) if entry is not None else {}
        rows[run["name"]] = {"day": str(run["recorded_at"])[:10]} | own
    table = pd.DataFrame.from_dict(rows, orient="index")
    return table.replace("", None).dropna(axis="columns", how="all")


def _entry_of(campaign: Campaign, run: Mapping[str, Any]) -> RunEntry | None:
    for entry in campaign.run:
        if any(is_named(campaign, entry.files, file) for file in run["files"]):
            return entry
    return None


def _entry_labels(entry: RunEntry, file: str, pattern: str | None) -> dict[str, str]:
    named = NamePattern(pattern).labels(PurePosixPath(file).stem) if pattern else {}
    return named | entry.labels
