"""What the command line shows of results: short tables, and where to look next."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table

from tribolab.campaign.outcome import CurveOutcome, Outcome

if TYPE_CHECKING:
    import pandas as pd

    from tribolab.report.demo import DemoComparison

_PIPED_WIDTH = 120
_SHOWN = 10


def console() -> Console:
    """Return a console on stdout; a pipe has no width of its own."""
    out = Console(highlight=False)
    return out if out.is_terminal else Console(highlight=False, width=_PIPED_WIDTH)


def outcome_table(outcome: Outcome) -> Table:
    """Return one row per measured curve: what was measured, at what speeds, how much friction."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading in ("surface", "medium"):
        table.add_column(heading)
    for heading in ("load", "runs", "segments", "speeds", "friction coefficient"):
        table.add_column(heading, justify="right")
    for curve in outcome.curves:
        if curve.done:
            load = "" if curve.normal_force is None else f"{curve.normal_force:g} N"
            name = curve.surface or curve.run_names[0]
            table.add_row(name, curve.medium, load, *_numbers(curve, outcome.folder))
    return table


def _numbers(curve: CurveOutcome, folder: Path) -> tuple[str, str, str, str]:
    from tribolab.io.netcdf import read_netcdf

    data = read_netcdf(folder / curve.data_file)
    segments = f"{int(data.segments.sum())}" if "segments" in data else ""
    speed, mu = data.sliding_speed.values, data.friction_coefficient.values
    if not speed.size:  # e.g. nothing told the speed
        return str(len(curve.run_names)), segments, "", ""
    ends = _range(f"{speed.min():.2g}", f"{speed.max():.2g}")
    return (
        str(len(curve.run_names)),
        segments,
        f"{ends} m/s",
        _range(f"{mu.min():.3f}", f"{mu.max():.3f}"),
    )


def _range(low: str, high: str) -> str:
    return low if low == high else f"{low} to {high}"


def outcome_lines(outcome: Outcome) -> list[str]:
    """Say how many runs were done, taken over and failed, and where the report is."""
    done = [run for run in outcome.runs if run.done]
    reused = sum(run.reused for run in done)
    line = f"{len(done)} of {len(outcome.runs)} runs, {outcome.segments} segments"
    if reused:
        line += f"; {reused} unchanged since the last time"
    lines = [line]
    for quality, what in (("error", "crashed"), ("fail", "failed"), ("suspect", "are suspect in")):
        names = [run.name for run in outcome.runs if run.quality == quality]
        names += [f"scans of {s.name}" for s in outcome.surfaces if quality in s.objections]
        if names:
            more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
            lines.append(f"checks {what}: {', '.join(names[:_SHOWN])}{more}")
    if known := [surface for surface in outcome.surfaces if surface.files]:
        done = sum(surface.done for surface in known)
        lines.append(f"{done} of {len(known)} surfaces: {_computed(outcome)}")
    lines += [f"no curve of {c.name}: {c.reason}" for c in outcome.curves if not c.done]
    return [*lines, f"report: {shown(outcome.folder / 'report.html')}"]


def _computed(outcome: Outcome) -> str:
    """Say what is known of the surfaces."""
    words = {"psd": "spectrum", "contact": "contact", "adhesion": "adhesion"}
    parts = {part for surface in outcome.surfaces for part in surface.parts}
    return ", ".join(word for part, word in words.items() if part in parts) or "nothing"


def failure_lines(outcome: Outcome) -> list[str]:
    """Say which runs, surfaces and scans failed and why."""
    failed = [f"{run.name} failed: {run.reason}" for run in outcome.failed]
    for surface in outcome.surfaces:
        failed += [f"surface {surface.name}: {finding.message}" for finding in surface.unreadable]
    lines = failed[:_SHOWN]
    if len(failed) > _SHOWN:
        lines.append(f"... and {len(failed) - _SHOWN} more; all stand in the report")
    return lines


def truth_lines(compared: DemoComparison, outcome: Outcome) -> list[str]:
    """Say how well truth and paper were found, where to look and what to do next."""
    c, folder, results = compared.runs, compared.folder, outcome.folder
    rows = compared.surfaces
    lines = [
        "",
        f"against the truth: {c.found} of {c.true} segments found, {c.missed} missed, "
        f"{c.extra} extra; the true friction coefficient lies within 1 standard error in "
        f"{100 * c.within_1:.0f} %, within 3 in {100 * c.within_3:.1f} % of them",
    ]
    if len(rows):
        off = rows.assign(off=100 * rows.relative_difference.abs()).groupby("quantity").off.max()
        words = {"rms_roughness_m": "roughness", "rms_slope": "slope", "contact_area_ratio": "A/A0"}
        text = ", ".join(f"{words[name]} {off[name]:.1f} %" for name in words if name in off)
        lines.append(
            f"surfaces, from their scans: at most {text} from the truth; "
            f"{rows.within_bounds.sum()} of {len(rows)} within their bounds"
        )
    fits, lost = compared.shear_stress, _not_described(results)
    if len(fits):
        lines.append(
            f"shear stresses, fitted with the scanned spectra: at most "
            f"{100 * fits.relative_difference.abs().max():.1f} % from the truth; "
            f"{fits.within_interval.sum()} of {len(fits)} within their 95 % intervals{lost}"
        )
    lines.append(f"against the paper: {_counted(compared.paper)}")
    tables = shown(results / "tables")
    return [
        *lines,
        "",
        f"look at   {shown(results / 'report.html')}        the page: open it in a browser",
        f"          {tables}/friction.csv  every segment, a row each",
        f"          {tables}/truth.csv     every segment beside its truth",
        f"          {tables}/paper.csv     the paper's numbers beside computed ones",
        f"then try  tribolab info {shown(folder)}/raw/friction/*_force.csv",
        f"          tribolab run {shown(folder)}/campaign.toml  after changing something in it",
    ]


def _not_described(results: Path) -> str:
    """Say in brackets how many curves of which surface the model does not describe."""
    import pandas as pd

    from tribolab.report.model_words import is_described
    from tribolab.report.wording import many

    path = results / "tables" / "shear_stress.csv"
    if not path.is_file():
        return ""
    fits = pd.read_csv(path)
    fits = fits[[not is_described(words) for words in fits.judgement]]
    said = [f"{many(n, 'curve')} of {name}" for name, n in fits.surface.value_counts().items()]
    verb = "is" if len(fits) == 1 else "are"
    return f" ({', '.join(said)} {verb} not described by the model)" if said else ""


def _counted(table: pd.DataFrame) -> str:
    count = table.status.value_counts()
    said = ", ".join(f"{number} {status}" for status, number in count.items())
    return f"{len(table)} numbers, {said}"


def paper_lines(folder: Path, table: pd.DataFrame) -> list[str]:
    """Say how many of the paper's numbers hold, which differ, and where to look.

    Parameters
    ----------
    folder
        The results of `tribolab.report.paper.reproduce.reproduce`.
    table
        Published numbers beside computed ones.
    """
    lines = [f"the paper: {_counted(table)}"]
    for row in table[table.status == "differs"].itertuples():
        what = f"{row.quantity}, {row.surface}, {row.condition}"
        lines.append(f"differs: {what}: published {row.published}, computed {row.computed}")
    return [
        *lines,
        "",
        f"look at   {shown(folder / 'paper.html')}  the page: open it in a browser",
        f"          {shown(folder / 'paper.csv')}   all numbers, a row each",
    ]


def file_lines(description: Mapping[str, Any]) -> list[str]:
    """Say how a raw file is understood.

    Parameters
    ----------
    description
        From `tribolab.io.runs.describe`.
    """
    d = description
    title = f" ({d['title']})" if d["title"] else ""
    lines = [f"{d['file']}: {d['instrument'] or 'netCDF'}{title}"]
    sampling = f"  {d['rows']} rows over {d['duration_s']:.6g} s"
    if d["interval_s"] is not None:
        sampling += f", one every {d['interval_s']:.3g} s, at most {d['longest_interval_s']:.3g} s"
    lines.append(sampling + (f", {d['steps']} steps" if d["steps"] else ""))
    width = max((len(name) for name in d["columns"]), default=0)
    for name, column in d["columns"].items():
        span = _range(f"{column['minimum']:.6g}", f"{column['maximum']:.6g}")
        span += f" {column['unit']}" if column["unit"] != "1" else ""
        label = f"   from '{column['label']}'" if column["label"] else ""
        lines.append(f"  {name:<{width}}  {span}{label}")
    if d["not_used"]:
        lines.append(f"  not used: {', '.join(d['not_used'])}")
    lines += [f"  {key}: {value}" for key, value in d["metadata"].items()]
    return lines


def shown(path: Path) -> str:
    """Return a path as short as it can be said from here."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
