"""What the demo adds to a report: its results beside the truth and beside the paper."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.report.truth import Comparison, compare_with_truth, write_truth
from tribolab.report.truth_shear_stress import compare_shear_stress, write_truth_shear_stress
from tribolab.report.truth_surfaces import compare_surfaces, write_truth_surfaces

if TYPE_CHECKING:
    from tribolab.campaign.outcome import Outcome


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
    runs: Comparison
    surfaces: pd.DataFrame
    shear_stress: pd.DataFrame
    paper: pd.DataFrame


def write(outcome: Outcome, folder: Path) -> DemoComparison:
    """Compare, and write ``truth*.csv`` and ``paper.csv``."""
    from tribolab.studies.comparison import compare_with_paper

    paper = compare_with_paper()
    runs, surfaces = write_truth(outcome, folder), write_truth_surfaces(outcome, folder)
    paper.to_csv(_paper_file(outcome), index=False, float_format="%.6g", lineterminator="\n")
    stresses = write_truth_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def compare(outcome: Outcome, folder: Path) -> DemoComparison:
    """Compare results that are complete; the paper's table is taken as it lies there."""
    from tribolab.studies.comparison import compare_with_paper

    there = _paper_file(outcome)
    paper = pd.read_csv(there) if there.is_file() else compare_with_paper()
    runs, surfaces = compare_with_truth(outcome, folder), compare_surfaces(outcome, folder)
    stresses = compare_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def _paper_file(outcome: Outcome) -> Path:
    return Path(outcome.folder) / "tables" / "paper.csv"
