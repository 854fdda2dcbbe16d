"""Command ``tribolab reproduce``: simulate, analyse, compute, draw, compare, write."""

from __future__ import annotations

import json
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.campaign.engine.executor import completed, workers
from tribolab.campaign.engine.stage import Progress, silent
from tribolab.campaign.store.staging import staged
from tribolab.core.untyped import Json
from tribolab.paper import laboratory as lab
from tribolab.paper.data import SURFACES, PaperData
from tribolab.paper.document import context_of, paper_document, paper_sections
from tribolab.paper.figures import FIGURES, DrawTask, draw_paper_figure
from tribolab.paper.work import PaperTask, compute
from tribolab.records.parts import Row
from tribolab.report import tables
from tribolab.report.page.templating import framed

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome
    from tribolab.campaign.surfaces.plan import PlannedSurface


@dataclass(frozen=True)
class Reproduction:
    """Results of a reproduction.

    Parameters
    ----------
    folder
        Folder of the results.
    table
        Published and computed numbers, as in ``paper.csv``.
    document
        Content of the page, as in ``paper.json``.
    """

    folder: Path
    table: pd.DataFrame
    document: Json


def reproduce(
    output: str | Path,
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
    laboratory: lab.Laboratory | None = None,
) -> Reproduction:
    """Reproduce figures and numbers of the reference paper, write a web page, and return them.

    Parameters
    ----------
    output
        Results folder, replaced as a whole: ``paper.html``, ``paper.csv``, ``paper.json``,
        ``figures/``, ``data/``, and the raw files of the virtual rig in ``simulated/``.
    jobs
        Number of processes; by default one per processor.
    progress
        Called as ``progress(stage, done, total)``.
    laboratory
        Programme of the virtual rig; by default that of the paper.

    Raises
    ------
    ConfigError, OutputError
        If `output` contains other files, or cannot be written.
    """
    laboratory = laboratory or lab.Laboratory()
    place = Path(output).resolve()
    tell = progress or silent
    with staged(place) as folder:
        (folder / "figures").mkdir()
        with workers(jobs, modules=(__name__,)) as pool:
            campaign = lab.simulate_laboratory(laboratory, folder, pool, tell)
            outcome, scans = lab.analyse_laboratory(campaign, folder, pool, tell)
            table, fits = _compute(outcome, scans, pool, tell)
            data = PaperData(folder, outcome.runs, outcome.curves, fits)
            figures = _drawn(data, pool, tell)
        document = paper_document(table, figures, fits, laboratory, outcome.sources)
        tables.write_csv(table, folder / "paper.csv", digits=6)
        tables.write_csv(fits, folder / "data" / "shear_stress.csv", digits=6)
        text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
        (folder / "paper.json").write_text(text + "\n", encoding="utf-8")
        page = framed("paper/page.html.j2", context_of(document), paper_sections(), folder)
        (folder / "paper.html").write_text(page, encoding="utf-8")
        tell("page", 1, 1)
    return Reproduction(place, table, document)


def _compute(
    outcome: Outcome, scans: Sequence[PlannedSurface], pool: Executor | None, tell: Progress
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Compute the theory, compare its numbers with the paper's, and fit the simulated curves."""
    folder = outcome.folder
    tasks = [PaperTask("published", "", folder)]
    for name in SURFACES:
        wet = [c for c in outcome.curves if (c.surface, c.medium) == (name, "glycerol")]
        # the paper computes Smooth at the lowest load only
        forces = sorted(c.normal_force for c in wet if c.normal_force is not None)
        forces = forces[: 1 if name == "Smooth" else None]
        tasks.append(PaperTask("wet", name, folder, tuple(forces), tuple(wet)))
    tasks += [PaperTask("dry", name, folder) for name in SURFACES]
    tasks += [PaperTask("spectrum", surface.name, folder, scans=surface) for surface in scans]
    rows: dict[tuple[str, str], list[Row]] = {}
    for task, future in completed(pool, compute, tasks):
        rows[task.kind, task.surface] = future.result()
        tell("theory", len(rows), len(tasks))
    table = pd.DataFrame(rows["published", ""])
    fitted = [row for name in SURFACES for row in rows["wet", name]]
    return table, _correct_stress(pd.DataFrame(fitted), folder)


def _correct_stress(fits: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """Return fitted shear stresses divided by the increase of area due to adhesion in glycerol."""
    data = PaperData(folder, (), (), fits)
    growth = []
    for fit in fits.to_dict("records"):
        loads = data.read("dry", fit["surface"], "loads").swap_dims(load="normal_force")
        mine = loads.area_enhancement.sel(medium="glycerol", normal_force=fit["normal_force_N"])
        growth.append(float(mine))
    return fits.assign(
        area_enhancement=growth,
        corrected_shear_stress_Pa=fits.shear_stress_Pa / growth,
        corrected_shear_stress_error_Pa=fits.shear_stress_error_Pa / growth,
    )


def _drawn(data: PaperData, pool: Executor | None, tell: Progress) -> list[Json]:
    done: dict[str, Json] = {}
    for task, future in completed(
        pool, draw_paper_figure, [DrawTask(figure.name, data) for figure in FIGURES]
    ):
        done[task.name] = future.result()
        tell("figures", len(done), len(FIGURES))
    return [done[figure.name] for figure in FIGURES]
