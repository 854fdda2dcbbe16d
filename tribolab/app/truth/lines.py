"""Terminal lines on the agreement of results with the simulated truth or with the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.app.terminal import from_here
from tribolab.campaign.store.outcome import Outcome
from tribolab.core.wording import Count

if TYPE_CHECKING:
    import pandas as pd

    from tribolab.app.truth.known import DemoComparison


def truth_lines(compared: DemoComparison, outcome: Outcome) -> list[str]:
    """Return lines on the agreement with the truth, and the next steps."""
    c, folder, results = compared.runs, compared.folder, outcome.folder
    rows = compared.surfaces
    lines = [
        "",
        f"compared with the true values of the simulation: {c.found} of {c.true} segments found, "
        f"{c.missed} missed, {c.extra} extra; the true friction coefficient is within 1 standard "
        f"error in {100 * c.within_1:.0f} % of them, within 3 in {100 * c.within_3:.1f} %",
    ]
    if len(rows):
        off = rows.assign(off=100 * rows.relative_difference.abs()).groupby("quantity").off.max()
        words = {"rms_roughness_m": "roughness", "rms_slope": "slope", "contact_area_ratio": "A/A0"}
        text = ", ".join(f"{words[name]} {off[name]:.1f} %" for name in words if name in off)
        lines.append(
            f"surfaces, from their scans: at most {text} off the true values; "
            f"{rows.within_bounds.sum()} of {len(rows)} values within their stated bounds"
        )
    fits, lost = compared.shear_stress, _not_described(results)
    if len(fits):
        lines.append(
            "shear stresses, fitted with the scanned spectra: at most "
            f"{100 * fits.relative_difference.abs().max():.1f} % off the true values; "
            f"{fits.within_interval.sum()} of {len(fits)} within their 95 % intervals{lost}"
        )
    return [
        *lines,
        "",
        f"look at   {from_here(results / 'report.html')}  the page: open it in a browser",
        f"then try  tribolab info {from_here(folder)}/raw/friction/*_force.csv",
        f"          tribolab run {from_here(folder)}/campaign.toml  after changing something in it",
    ]


def _not_described(results: Path) -> str:
    """Return text in brackets on the number of curves per surface that the model does not fit."""
    # imported late for a quick start
    from tribolab.records.models.model_words import is_described
    from tribolab.report import tables

    path = results / "tables" / "shear_stress.csv"
    if not path.is_file():
        return ""
    fits = tables.read_csv(path)
    fits = fits[[not is_described(words) for words in fits.judgement]]
    counts = [
        f"{Count(n):curve|curves} of {name}" for name, n in fits.surface.value_counts().items()
    ]
    verb = "is" if len(fits) == 1 else "are"
    return f" ({', '.join(counts)} {verb} not described by the model)" if counts else ""


def paper_lines(folder: Path, table: pd.DataFrame) -> list[str]:
    """Return lines on how many of the paper's numbers agree, and which differ.

    Parameters
    ----------
    folder
        Folder of the results of `tribolab.paper.reproduce.reproduce`.
    table
        Published and computed numbers.
    """
    # imported late for a quick start
    from tribolab.studies.tally import tell_statuses
    from tribolab.studies.verdict import DIFFERS

    lines = [f"the paper: {tell_statuses(table)}"]
    for row in table[table.status == DIFFERS].itertuples():
        what = f"{row.quantity}, {row.surface}, {row.condition}"
        lines.append(f"differs: {what}: published {row.published}, computed {row.computed}")
    return [
        *lines,
        "",
        f"look at   {from_here(folder / 'paper.html')}  the page: open it in a browser",
        f"          {from_here(folder / 'paper.csv')}   all numbers, a row each",
    ]
