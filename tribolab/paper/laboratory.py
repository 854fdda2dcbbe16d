"""Simulation of the paper's measurements by the virtual rig, and the analysis of its files."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.engine.stage import Progress
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.surfaces.plan import plan_surfaces
from tribolab.core.errors import AnalysisError
from tribolab.rig import Protocol, Rig, simulate_campaign
from tribolab.studies import xu2026

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.store.outcome import Outcome
    from tribolab.campaign.surfaces.plan import PlannedSurface

_FOLDER = "simulated"


@dataclass(frozen=True)
class Laboratory:
    """Programme of the virtual rig; by default that of the paper, with one run per condition.

    Parameters
    ----------
    loads
        Normal forces [N] in glycerol; dry runs use the lowest.
    speeds
        Sliding speeds [m/s]; 3 um/s is included because the paper shows traces at it.
    scans
        Profiles of each surface.
    seed
        The same seed gives the same raw files.
    """

    loads: tuple[float, ...] = xu2026.system.loads
    speeds: tuple[float, ...] = tuple(sorted({*xu2026.SPEEDS, 3e-6}))
    scans: int = xu2026.profilometer.scans
    seed: int = 0


def simulate_laboratory(
    laboratory: Laboratory, folder: Path, executor: Executor | None, progress: Progress
) -> Campaign:
    """Write the raw files of the virtual rig to a folder, and return the campaign."""
    file = simulate_campaign(
        folder / _FOLDER,
        laboratory.seed,
        loads=laboratory.loads,
        n_repeats=1,
        n_scans=laboratory.scans,
        rig=Rig(protocol=Protocol(speeds=laboratory.speeds)),
        progress=progress,
        executor=executor,
    )
    return load_campaign(file)


def analyse_laboratory(
    campaign: Campaign, folder: Path, executor: Executor | None, progress: Progress
) -> tuple[Outcome, tuple[PlannedSurface, ...]]:
    """Return the analysis of the virtual rig's files, by the same pipeline as for real ones.

    Returns
    -------
    tuple
        Results of the runs, whose data files are in ``data/``, and the surfaces with their
        scans. Contact and models are computed elsewhere, from the stand-in spectra.

    Raises
    ------
    AnalysisError
        If a run failed.
    """
    runs_only = campaign.model_copy(
        update={"surface": (), "model": campaign.model.model_copy(update={"compute": False})}
    )
    outcome = process(runs_only, folder, executor=executor, progress=progress)
    if outcome.failed:
        run = outcome.failed[0]
        raise AnalysisError(f"the virtual rig's run {run.name} failed: {run.reason}")
    return replace(outcome, folder=folder), plan_surfaces(campaign, outcome.runs)
