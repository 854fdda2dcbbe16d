"""The two sides of a comparison: results folders, tables, or two levels within one of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from tribolab.comparison.folder import Folder, open_folder
from tribolab.comparison.run_values import segments_of, select_level
from tribolab.core.errors import AnalysisError
from tribolab.report.results_folder import Results

Compared = str | Path | Results | pd.DataFrame


@dataclass(frozen=True)
class Side:
    """One of the two groups of runs that are compared.

    Parameters
    ----------
    name
        Name in texts.
    segments
        Its segments as rows of the table of friction.
    folder
        Results folder; None for a table.
    tables
        Tables of shear stresses and roughness, if any.
    """

    name: str
    segments: pd.DataFrame
    folder: Folder | None = None
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)


def sides_of(
    first: Compared, second: Compared | None, by: str, levels: Sequence[str]
) -> tuple[Side, Side]:
    """Return the two sides of a comparison; arguments as for `compare`.

    Raises
    ------
    AnalysisError
        If the sides are not defined, or a results folder has no runs.
    """
    if second is not None:
        sides = _side(first, "first"), _side(second, "second")
        return sides if sides[0].name != sides[1].name else _distinct_names(sides)
    if not by:
        raise AnalysisError(
            "there is nothing to compare with: name a second folder, or say by which column two "
            "parts of the first differ, e.g. surface"
        )
    whole = _side(first, "table")
    known = (
        [str(level) for level in dict.fromkeys(whole.segments[by].dropna())]
        if (by in whole.segments)
        else []
    )
    chosen = list(levels) or known[:2]
    if len(chosen) != 2:
        raise AnalysisError(f"two levels of {by} are compared with each other; got {len(chosen)}")
    halves = [
        Side(
            level,
            select_level(whole.segments, by, level),
            whole.folder,
            {n: t[t[by].astype(str) == level] for n, t in whole.tables.items() if by in t},
        )
        for level in chosen
    ]
    return halves[0], halves[1]


def _distinct_names(alike: tuple[Side, Side]) -> tuple[Side, Side]:
    """Return two sides with different names, also for two folders of the same name."""
    names = [
        str(side.folder.path) if side.folder else f"{side.name} ({word})"
        for side, word in zip(alike, ("first", "second"), strict=True)
    ]
    sides = [
        Side(name, side.segments, side.folder, side.tables)
        for name, side in zip(names, alike, strict=True)
    ]
    return sides[0], sides[1]


def _side(given: Compared, name: str) -> Side:
    if isinstance(given, pd.DataFrame):
        return Side(name, segments_of(given, name))
    folder = open_folder(given.folder if isinstance(given, Results) else given)
    table = folder.friction()
    if counting := folder.counting:
        table = table[table["run"].astype(str).isin(counting)]
    known = {name: folder.table(name) for name in ("shear_stress", "roughness")}
    return Side(
        folder.name,
        segments_of(table, folder.path),
        folder,
        {name: table for name, table in known.items() if table is not None},
    )
