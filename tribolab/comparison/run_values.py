"""Friction of each run at each speed: the observations that are compared between campaigns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from tribolab.core.errors import AnalysisError, shown
from tribolab.core.wording import force_text

CONDITION = ["surface", "medium", "nominal_normal_force_N"]
SPEED_COLUMN = "sliding_speed_m_s"
VALUE = "friction_coefficient"
TOLERANCE = 0.1  # relative difference up to which speeds are taken as equal, as in measured curves


@dataclass(frozen=True)
class MatchedRuns:
    """Runs of two groups in the same condition, at their common speeds.

    Parameters
    ----------
    condition
        Surface, medium and load in words.
    speeds
        Common speeds [m/s] (speed).
    first, second
        Mean friction coefficient of each run (run, speed); NaN if missing.
    first_runs, second_runs
        Names of the runs.
    """

    condition: str
    speeds: np.ndarray
    first: np.ndarray
    second: np.ndarray
    first_runs: tuple[str, ...]
    second_runs: tuple[str, ...]


def condition_text(surface: object, medium: object, load: float) -> str:
    """Return a condition (surface, medium, load) as text.

    Examples
    --------
    >>> condition_text("Sb-R", "dry", 31.0), condition_text("", float("nan"), float("nan"))
    ('Sb-R, dry, 31 N', 'all runs')
    """
    words = [str(word) for word in (surface, medium) if isinstance(word, str) and word]
    if np.isfinite(load):
        words.append(force_text(load))
    return ", ".join(words) or "all runs"


def segments_of(table: pd.DataFrame, where: object = "table") -> pd.DataFrame:
    """Return the segments with known speed and friction coefficient.

    Segments that a person rejected are left out.

    Raises
    ------
    AnalysisError
        If columns are missing, or nothing is left.
    """
    missing = [name for name in ("run", SPEED_COLUMN, VALUE) if name not in table]
    if missing:
        raise AnalysisError(f"{where}: the table of friction has no column {', '.join(missing)}")
    kept = table[np.isfinite(table[VALUE]) & (table[SPEED_COLUMN] > 0)]
    if "rejected" in kept:
        kept = kept[kept["rejected"] != 1]
    if kept.empty:
        raise AnalysisError(f"{where}: no segment has a sliding speed and a friction coefficient")
    return kept.assign(**{name: np.nan for name in CONDITION if name not in kept})


def speed_levels(speeds: np.ndarray) -> np.ndarray:
    """Return, for each speed, the geometric mean [m/s] of the group of speeds it belongs to.

    Neighbouring speeds within 10 % of each other form a group.

    Examples
    --------
    >>> speed_levels(np.array([1.0, 10.0, 1.02])).round(3).tolist()
    [1.01, 10.0, 1.01]
    """
    order = np.argsort(speeds, kind="stable")
    log = np.log(speeds[order])
    group = np.cumsum(np.diff(log, prepend=log[:1]) > np.log1p(TOLERANCE))
    means = np.bincount(group, log) / np.bincount(group)
    levels = np.empty_like(speeds)
    levels[order] = np.exp(means[group])
    return levels


def match_runs(
    first: pd.DataFrame, second: pd.DataFrame, by: Sequence[str] = tuple(CONDITION)
) -> list[MatchedRuns]:
    """Return the runs of two groups, matched by condition and speed.

    Parameters
    ----------
    first, second
        Segments, from `segments_of`.
    by
        Columns that define a condition.

    Returns
    -------
    list of Matched
        Common conditions and speeds, in the order of the first group.
    """
    keys = [_condition_keys(segments, by) for segments in (first, second)]
    result = []
    for key in dict.fromkeys(keys[0].tolist()):
        mine, theirs = first[keys[0] == key], second[keys[1] == key]
        if theirs.empty:
            continue
        levels = speed_levels(np.concatenate([mine[SPEED_COLUMN], theirs[SPEED_COLUMN]]))
        a = _per_run(mine, levels[: len(mine)])
        b = _per_run(theirs, levels[len(mine) :])
        speeds = a.columns.intersection(b.columns)
        if speeds.empty:
            continue
        row = mine.iloc[0].reindex(CONDITION)
        text = condition_text(*(row[name] if name in by else np.nan for name in CONDITION))
        result.append(
            MatchedRuns(
                text,
                speeds.to_numpy(dtype=float),
                a[speeds].to_numpy(dtype=float),
                b[speeds].to_numpy(dtype=float),
                tuple(map(str, a.index)),
                tuple(map(str, b.index)),
            )
        )
    return result


def select_level(segments: pd.DataFrame, by: str, level: str) -> pd.DataFrame:
    """Return the segments with one value of a column, e.g. of one surface.

    Raises
    ------
    AnalysisError
        If the column or level does not exist.
    """
    if by not in segments:
        raise AnalysisError(f"the table of friction has no column '{shown(by)}'")
    names = [str(name) for name in dict.fromkeys(segments[by].dropna())]
    if level not in names:
        listed = ", ".join(map(shown, names))
        raise AnalysisError(f"no {shown(by)} is called '{shown(level)}'; there is {listed}")
    return segments[segments[by].astype(str) == level]


def _condition_keys(segments: pd.DataFrame, by: Sequence[str]) -> pd.Series:
    """Return the condition of each segment as text; unknown loads count as equal."""
    columns = [segments[name].tolist() for name in by]
    texts = [
        "\n".join(f"{v:.6g}" if isinstance(v, float) else str(v) for v in row)
        for row in zip(*columns, strict=True)
    ]
    return pd.Series(texts if columns else "", segments.index, dtype=object)


def _per_run(segments: pd.DataFrame, levels: np.ndarray) -> pd.DataFrame:
    """Return the mean coefficient of each run (row) at each speed (column)."""
    known = segments.assign(level=levels)
    return known.pivot_table(index="run", columns="level", values=VALUE, aggfunc="mean")
