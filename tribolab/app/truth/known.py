"""Results of a simulated campaign beside all that is known of it: its truth, and the paper."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.app.truth.friction import TruthComparison, compare_with_truth
from tribolab.app.truth.shear_stress import compare_shear_stress
from tribolab.app.truth.surfaces import compare_surfaces
from tribolab.report import tables
from tribolab.studies.comparison import compare_with_paper

if TYPE_CHECKING:
    import pandas as pd

    from tribolab.campaign.store.outcome import Outcome


@dataclass(frozen=True)
class DemoComparison:
    """Results of a simulated campaign beside what is known.

    Parameters
    ----------
    folder
        The campaign's folder.
    runs
        Segments beside the true ones.
    surfaces
        Roughness and contact beside the true ones.
    shear_stress
        Fitted shear stresses beside the true ones.
    paper
        The paper's numbers beside computed ones.
    """

    folder: Path
    runs: TruthComparison
    surfaces: pd.DataFrame
    shear_stress: pd.DataFrame
    paper: pd.DataFrame


def compare_with_known(
    outcome: Outcome, folder: Path, paper: pd.DataFrame, executor: Executor | None = None
) -> DemoComparison:
    """Compare a simulated campaign's results with its truth.

    Parameters
    ----------
    outcome
        Results whose data files lie in ``outcome.folder``.
    folder
        The simulated campaign's folder.
    paper
        From `compare_with_paper`.
    executor
        Where the runs are compared; without one it is done here.
    """
    runs = compare_with_truth(outcome, folder, executor)
    surfaces, stresses = compare_surfaces(outcome, folder), compare_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def write_comparison(outcome: Outcome, compared: DemoComparison) -> None:
    """Write ``truth*.csv`` and ``paper.csv``."""
    for name, table in (
        ("truth", compared.runs.table),
        ("truth_surfaces", compared.surfaces),
        ("truth_shear_stress", compared.shear_stress),
    ):
        tables.write_csv(table, Path(outcome.folder) / "tables" / f"{name}.csv", digits=9)
    tables.write_csv(compared.paper, _paper_file(outcome), digits=6)


def paper_of(outcome: Outcome) -> pd.DataFrame:
    """Return the paper's table as it lies in the results; computed if it does not."""
    there = _paper_file(outcome)
    return tables.read_csv(there) if there.is_file() else compare_with_paper()


def _paper_file(outcome: Outcome) -> Path:
    return Path(outcome.folder) / "tables" / "paper.csv"
