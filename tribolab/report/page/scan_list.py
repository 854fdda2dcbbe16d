"""Rows of the page's list of scans, those with failed checks first."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any, NamedTuple

_FAILED = ("error", "fail")
_ORDER = (*_FAILED, "suspect")


class ListedScan(NamedTuple):
    """Row of one scan: its name, surface and state, and the message of its worst check."""

    name: str
    surface: str
    state: str
    why: str


def listed_scans(document: Mapping[str, Any]) -> list[ListedScan]:
    """Return a row for each scan of all surfaces: rejected first, then suspect, then others."""
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
