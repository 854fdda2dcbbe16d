"""List of all scans, worst first."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any, NamedTuple

_FAILED = ("error", "fail")
_ORDER = (*_FAILED, "suspect")


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
            worst = mine[0]["status"] if mine else "ok"
            state = "rejected" if worst in _FAILED else worst
            rows.append(
                ListedScan(name, surface["name"], state, mine[0]["message"] if mine else "")
            )
    return sorted(rows, key=lambda row: ["rejected", "suspect", "ok"].index(row.state))
