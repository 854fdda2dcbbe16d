"""Comparison of segments and friction with the truth of a simulated campaign."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from tribolab.campaign.store.outcome import Outcome
from tribolab.core.errors import AnalysisError
from tribolab.records.runs.run_record import RunRecord
from tribolab.rig import read_truth

_HALF = 0.5
# measured columns that the table shows next to the true ones
_COLUMNS = [
    *("start_s", "stop_s", "direction", "sliding_speed_m_s"),
    *("friction_coefficient", "friction_coefficient_sem"),
]


@dataclass(frozen=True)
class TruthComparison:
    """Agreement of segments and friction with the truth.

    Parameters
    ----------
    table
        One row per true segment, and one per extra segment.
    true, found, missed, extra
        Numbers of segments.
    within_1, within_3
        Share of the found segments whose measured friction coefficient is within one (three)
        standard errors of the true one; NaN if no segment was found.
    """

    table: pd.DataFrame
    true: int
    found: int
    missed: int
    extra: int
    within_1: float
    within_3: float


def compare_with_truth(outcome: Outcome, folder: str | Path) -> TruthComparison:
    """Compare the segments and friction of a simulated campaign with the truth.

    Parameters
    ----------
    outcome
        The campaign's results.
    folder
        The simulated campaign's folder.

    Returns
    -------
    TruthComparison
        A true segment counts as found if a measured one of the same direction covers more than half
        of it. All segments of a failed run count as missed.

    Raises
    ------
    AnalysisError
        If the simulated campaign does not contain the true values of a run.
    """
    truth = read_truth(folder)
    for run in outcome.runs:
        if run.name not in truth.segments:
            raise AnalysisError(
                f"{run.name}: {folder} does not contain the true values of this run"
            )
    tables = [
        compare_run(
            entry.name,
            truth.segments[entry.name],
            pd.DataFrame(entry.record.facts.segments),
            entry.record.facts.time_origin_s or 0.0,
        )
        for entry in outcome.store.all("run", RunRecord)
    ]
    return summary(pd.concat(tables, ignore_index=True))


def compare_run(
    name: str, true: pd.DataFrame, measured: pd.DataFrame, time_origin: float
) -> pd.DataFrame:
    """Match the segments of one run with the true ones.

    Parameters
    ----------
    name
        Name of the run.
    true
        Columns ``start_s``, ``stop_s`` (force clock), ``sliding_speed_m_s``, ``direction`` and
        ``friction_coefficient``.
    measured
        Measured segments with the same columns; none for a run that failed.
    time_origin
        Raw time of the run's first sample [s].

    Returns
    -------
    pandas.DataFrame
        One row per true segment (status found or missed), then the extra ones.
    """
    start, stop = true["start_s"].to_numpy(), true["stop_s"].to_numpy()
    size = len(measured)
    known = measured.reindex(columns=_COLUMNS)
    values = {column: known[column].to_numpy(float) for column in _COLUMNS}
    values["start_s"] = values["start_s"] + time_origin
    values["stop_s"] = values["stop_s"] + time_origin
    overlap = np.minimum.outer(stop, values["stop_s"]) - np.maximum.outer(start, values["start_s"])
    same = np.equal.outer(true["direction"].to_numpy(), values["direction"])
    cover = np.where(same, overlap, -np.inf) / (stop - start)[:, None]
    best = cover.argmax(axis=1) if size else np.zeros(len(true), dtype=int)
    hit = cover.max(axis=1, initial=-np.inf) > _HALF
    # if a measured segment covers two true ones, the less covered one counts as missed
    order = np.argsort(-cover.max(axis=1, initial=-np.inf), kind="stable")
    taken: dict[int, int] = {}
    for row in order[hit[order]]:
        taken.setdefault(int(best[row]), int(row))
    hit = np.isin(np.arange(len(true)), list(taken.values()))

    table = pd.DataFrame({"run": name, "status": np.where(hit, "found", "missed")})
    for column in ("start_s", "stop_s", "sliding_speed_m_s", "direction", "friction_coefficient"):
        table[f"true_{column}"] = true[column].to_numpy()
    extra = np.setdiff1d(np.arange(size), list(taken))
    table = pd.concat(
        [table, pd.DataFrame({"run": name, "status": ["extra"] * extra.size})], ignore_index=True
    )
    index = np.concatenate([np.where(hit, best, -1), extra]).astype(int)
    for column, value in values.items():
        table[column] = np.append(value, np.nan)[index]
    error = table["friction_coefficient"] - table["true_friction_coefficient"]
    table["error_in_standard_errors"] = error / table["friction_coefficient_sem"]
    return table


def summary(table: pd.DataFrame) -> TruthComparison:
    """Return the numbers of found, missed and extra segments, and the coverage of the errors."""
    status = table["status"]
    errors = table["error_in_standard_errors"].abs()[status == "found"].dropna()
    return TruthComparison(
        table=table,
        true=int((status != "extra").sum()),
        found=int((status == "found").sum()),
        missed=int((status == "missed").sum()),
        extra=int((status == "extra").sum()),
        within_1=float((errors <= 1).mean()) if errors.size else float("nan"),
        within_3=float((errors <= 3).mean()) if errors.size else float("nan"),
    )
