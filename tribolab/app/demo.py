"""Demo: a simulated campaign, its results, and their deviation from the truth."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.app.needed import ANALYSIS, SIMULATION
from tribolab.app.quick import importing
from tribolab.campaign.engine.executor import workers
from tribolab.campaign.engine.pool import LastingPool

if TYPE_CHECKING:
    from tribolab.app.truth.known import DemoComparison
    from tribolab.campaign.engine.stage import Progress
    from tribolab.campaign.store.outcome import Outcome


def run_demo(
    folder: Path, *, jobs: int | None = None, progress: Progress | None = None
) -> tuple[Outcome, DemoComparison]:
    """Simulate and analyse the reference campaign, and compare the results with the truth.

    Parameters
    ----------
    folder
        Folder of the campaign.
    jobs
        Number of processes; 1 does everything here. By default one per processor.
    progress
        Called as ``progress(stage, done, total)``.
    """
    with workers(jobs, modules=SIMULATION + ANALYSIS) as pool:
        if isinstance(pool, LastingPool):
            pool.prepare()
        # this process imports while the workers do
        with importing():
            # imported late: the workers have started
            from tribolab.app import plain  # noqa: F401
            from tribolab.app.run import run_campaign
            from tribolab.app.truth.known import compare_with_known, write_comparison
            from tribolab.campaign import pipeline  # noqa: F401
            from tribolab.report import results  # noqa: F401
            from tribolab.rig.campaign import simulate_campaign

        campaign = folder / "campaign.toml"
        if not (campaign.is_file() and (folder / "truth" / "truth.json").is_file()):
            simulate_campaign(folder, executor=pool, progress=progress)
        outcome = run_campaign(campaign, executor=pool, jobs=None if pool else 1, progress=progress)
    compared = compare_with_known(outcome, folder)
    write_comparison(compared)
    return outcome, compared
