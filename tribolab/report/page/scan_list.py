"""List of all scans, worst first."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any, NamedTuple

_ORDER = ("error", "fail", "suspect")


class ListedScan(NamedTuple):
    """Scan, its surface, and the most severe objection of its checks in words."""

    name: str
    surface: str
    state: str
    why: str


def listed_scans(document: Mapping[str, Any]) -> list[ListedScan]:
    """Return the scans of all surfaces, those with objections first."""
    rows = []
    for surface in document["surfaces"]:
        for file in surface["files"]:
            name = PurePath(file).name
            mine = [
                row
                for row in surface["checks"]
                if row["status"] in _ORDER and PurePath(row["scan"]).name == name
            ]
            mine.sort(key=lambda row: _ORDER.index(row["status"]))
            state, why = (mine[0]["status"], mine[0]["message"]) if mine else ("ok", "")
            rows.append(ListedScan(name, surface["name"], state, why))
    return sorted(rows, key=lambda row: [*_ORDER, row.state].index(row.state))
