"""What the demo adds to a report: its results beside the truth and beside the paper."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.app.truth import Comparison, compare_with_truth, write_truth
from tribolab.app.truth_shear_stress import compare_shear_stress, write_truth_shear_stress
from tribolab.app.truth_surfaces import compare_surfaces, write_truth_surfaces
from tribolab.campaign.engine.executor import workers
from tribolab.report import tables

if TYPE_CHECKING:
    from tribolab.campaign.engine.stage import Progress
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
    runs: Comparison
    surfaces: pd.DataFrame
    shear_stress: pd.DataFrame
    paper: pd.DataFrame


def run_demo(
    folder: Path, *, jobs: int | None = None, progress: Progress | None = None
) -> tuple[Outcome, DemoComparison]:
    """Simulate the reference campaign if it is not there yet, analyse it, and compare.

    Parameters
    ----------
    folder
        The campaign's folder.
    jobs
        Number of processes; 1 does everything here. By default one per processor.
    progress
        Called as ``progress(stage, done, total)``.
    """
    from tribolab.app.run import run_campaign
    from tribolab.rig import simulate_campaign
    from tribolab.studies.comparison import compare_with_paper

    campaign = folder / "campaign.toml"
    compared = []
    with workers(jobs) as pool:
        if not (campaign.is_file() and (folder / "truth" / "truth.json").is_file()):
            simulate_campaign(folder, executor=pool, progress=progress)
        # begun early: it fills what the stages of the campaign leave idle
        paper = pool.submit(compare_with_paper) if pool else None
        outcome = run_campaign(
            campaign,
            executor=pool,
            jobs=None if pool else 1,
            progress=progress,
            finish=lambda outcome: compared.append(
                _write(outcome, folder, paper.result() if paper else compare_with_paper())
            ),
        )
    return outcome, compared[0] if compared else compare(outcome, folder)


def _write(outcome: Outcome, folder: Path, paper: pd.DataFrame) -> DemoComparison:
    """Compare, and write ``truth*.csv`` and ``paper.csv``."""
    runs, surfaces = write_truth(outcome, folder), write_truth_surfaces(outcome, folder)
    tables.write_csv(paper, _paper_file(outcome), digits=6)
    stresses = write_truth_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def compare(outcome: Outcome, folder: Path) -> DemoComparison:
    """Compare results that are complete; the paper's table is taken as it lies there."""
    from tribolab.studies.comparison import compare_with_paper

    there = _paper_file(outcome)
    paper = tables.read(there) if there.is_file() else compare_with_paper()
    runs, surfaces = compare_with_truth(outcome, folder), compare_surfaces(outcome, folder)
    stresses = compare_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def _paper_file(outcome: Outcome) -> Path:
    return Path(outcome.folder) / "tables" / "paper.csv"
