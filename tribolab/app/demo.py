"""What the demo adds to a report: its results beside the truth and beside the paper."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.app.needed import ANALYSIS, SIMULATION
from tribolab.app.run import run_campaign
from tribolab.app.truth.friction import TruthComparison, compare_with_truth
from tribolab.app.truth.shear_stress import compare_shear_stress
from tribolab.app.truth.surfaces import compare_surfaces
from tribolab.campaign.engine.executor import workers
from tribolab.report import tables
from tribolab.rig import simulate_campaign
from tribolab.studies.comparison import compare_with_paper

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
    runs: TruthComparison
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
    campaign = folder / "campaign.toml"
    compared: list[DemoComparison] = []

    def finish(outcome: Outcome) -> None:
        known = paper.result() if paper else compare_with_paper()
        compared.append(_compared(outcome, folder, known, pool))
        _write(outcome, compared[0])

    with workers(jobs, modules=SIMULATION + ANALYSIS) as pool:
        if not (campaign.is_file() and (folder / "truth" / "truth.json").is_file()):
            simulate_campaign(folder, executor=pool, progress=progress)
        # begun early: it fills what the stages of the campaign leave idle
        paper = pool.submit(compare_with_paper) if pool else None
        outcome = run_campaign(
            campaign,
            executor=pool,
            jobs=None if pool else 1,
            progress=progress,
            finish=finish,
        )
    if not compared:  # nothing has changed: the paper's table is taken as it lies there
        there = _paper_file(outcome)
        known = tables.read(there) if there.is_file() else compare_with_paper()
        compared.append(_compared(outcome, folder, known))
    return outcome, compared[0]


def _compared(
    outcome: Outcome, folder: Path, paper: pd.DataFrame, executor: Executor | None = None
) -> DemoComparison:
    runs = compare_with_truth(outcome, folder, executor)
    surfaces, stresses = compare_surfaces(outcome, folder), compare_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses, paper)


def _write(outcome: Outcome, compared: DemoComparison) -> None:
    """Write ``truth*.csv`` and ``paper.csv``."""
    for name, table in (
        ("truth", compared.runs.table),
        ("truth_surfaces", compared.surfaces),
        ("truth_shear_stress", compared.shear_stress),
    ):
        tables.write_csv(table, Path(outcome.folder) / "tables" / f"{name}.csv", digits=9)
    tables.write_csv(compared.paper, _paper_file(outcome), digits=6)


def _paper_file(outcome: Outcome) -> Path:
    return Path(outcome.folder) / "tables" / "paper.csv"
