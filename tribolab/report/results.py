"""Write the report of a campaign: figures, tables, report.json and the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
from markupsafe import Markup

from tribolab.campaign.executor import completed
from tribolab.report import sliding, surface_records, tables
from tribolab.report.curve_figures import curve_record, draw_curves, plan_figures
from tribolab.report.document import labels, report_document, write_json
from tribolab.report.figure_files import DRAWING
from tribolab.report.model_figures import draw_model
from tribolab.report.model_part import write_models
from tribolab.report.page import PageTrace, write_page
from tribolab.report.part_rows import rows_of
from tribolab.report.run_summary import RunSummary, RunTask, summarise_run
from tribolab.report.sliding_figures import SlipFigure, draw_sliding, plan_sliding_figures
from tribolab.report.surface_figures import draw_surfaces, plan_surface_figures
from tribolab.report.surface_records import SurfaceRows, surface_record, surface_rows
from tribolab.report.traces import trace_size
from tribolab.words import explain

if TYPE_CHECKING:
    from tribolab.campaign.config import Campaign
    from tribolab.campaign.outcome import CurveOutcome, Outcome, RunOutcome

Progress = Callable[[str, int, int], None]


def write_report(
    outcome: Outcome, *, executor: Executor | None = None, progress: Progress | None = None
) -> None:
    """Write everything that the results folder has beside the data.

    Writes ``report.html`` (one page that opens offline), ``report.json`` (the same numbers),
    ``figures/*.svg`` and ``tables/*.csv``.

    Parameters
    ----------
    outcome
        From `tribolab.campaign.pipeline.process`; its folder has the data files.
    executor
        Any `concurrent.futures.Executor` for the drawing; without one it is done here.
    progress
        Called as ``progress(stage, done, total)``.

    Notes
    -----
    A run or a figure that cannot be shown is a finding of severity "error" and does not stop the
    rest of the report.
    """
    folder = Path(outcome.folder)
    for name in ("figures", "tables"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    tell = progress or (lambda stage, done, total: None)

    findings = _notes(outcome.campaign)
    findings += [_failure(run) for run in outcome.runs if not run.done]
    findings += [_kept(run) for run in outcome.runs if run.kept]
    findings += [_left_out(run) for run in outcome.runs if run.quality in ("fail", "error")]
    # what the others wait for begins first; meanwhile the rows of the tables are read here
    runs = _RunFigures(outcome, executor)
    with DRAWING:
        rows = rows_of(
            outcome.surfaces,
            lambda surface: surface_rows(surface, Path(outcome.folder)),
            findings,
            kind="surface",
        )
        models, model_tasks = write_models(outcome, findings)
    done = [surface for surface in outcome.surfaces if surface.name in rows]
    early = _Figures(
        {
            "surface_figures": (draw_surfaces, plan_surface_figures(done, folder)),
            "model_figures": (draw_model, model_tasks),
        },
        executor,
    )
    summaries = runs.collect(tell, findings)
    for summary in summaries.values():
        findings += summary.findings
    with DRAWING:
        curves, points = _curves(outcome, summaries, findings)
        readable = {curve["name"] for curve in curves}
        modes, slip_tasks, slip_rows = _sliding(outcome, readable, rows, findings)
    known = [curve for curve in outcome.curves if curve.name in readable]
    late = _Figures(
        {
            "figures": (draw_curves, plan_figures(known, folder)),
            "sliding_figures": (draw_sliding, slip_tasks),
        },
        executor,
    )
    drawn = early.collect(tell, findings) | late.collect(tell, findings)

    ordered = tables.findings_table(findings)
    _write_tables(outcome, summaries, points, ordered)
    tables.write(tables.together(slip_rows, ["run", "segment"]), folder / "tables/stick_slip.csv")
    for name in ("roughness", "contact", "adhesion"):
        columns = getattr(surface_records, name.upper())
        table = surface_records.table(list(rows.values()), name, columns)
        tables.write(table, folder / "tables" / f"{name}.csv")
    records = ordered.to_dict("records")
    document = report_document(outcome, summaries, curves, drawn.pop("figures"), records)
    document["surfaces"] = [surface_record(one, rows.get(one.name)) for one in outcome.surfaces]
    document |= {"sliding_mode": modes, "models": models, **drawn}
    write_json(document, folder / "report.json")
    traces = {
        name: PageTrace(summary.key, Markup(summary.trace), Markup(summary.fine))
        for name, summary in summaries.items()
        if summary.trace
    }
    write_page(document, folder, traces)
    tell("page", 1, 1)


def _notes(campaign: Campaign) -> list[dict[str, str]]:
    """Return the campaign file's own note as a finding, which the top of the page shows."""
    text = campaign.campaign.note
    return [{"severity": "note", "run": "", "where": "campaign", "message": text}] if text else []


def _failure(run: RunOutcome) -> dict[str, str]:
    reason = run.reason or run.error or "no reason was given"
    return {"severity": "fail", "run": run.name, "where": "run", "message": reason}


def _kept(run: RunOutcome) -> dict[str, str]:
    return {"severity": "fail", "run": run.name, "where": "run", "message": run.kept}


def _left_out(run: RunOutcome) -> dict[str, str]:
    text = "left out of the measured curves, because its checks failed; its own numbers are shown"
    return {"severity": "note", "run": run.name, "where": "curves", "message": text}


def _error(run: str, where: str, error: BaseException) -> dict[str, str]:
    return {"severity": "error", "run": run, "where": where, "message": explain(error)[0]}


class _RunFigures:
    """The figures and numbers of the runs, in work."""

    def __init__(self, outcome: Outcome, executor: Executor | None) -> None:
        done = [run for run in outcome.runs if run.done]
        points, fine_size = trace_size(len(done))
        tasks = [RunTask(run, Path(outcome.folder), points, fine_size) for run in done]
        self.names = [run.name for run in done]
        self.work = completed(executor, summarise_run, tasks)

    def collect(self, tell: Progress, findings: list[dict[str, str]]) -> dict[str, RunSummary]:
        """Wait for them; those that cannot be shown are findings."""
        found: dict[str, RunSummary] = {}
        for number, (task, future) in enumerate(self.work):
            error = future.exception()
            if error is None:
                found[task.run.name] = future.result()
            else:  # recorded: the other runs have their place in the report
                findings.append(_error(task.run.name, "report", error))
            tell("figures", number + 1, len(self.names))
        return {name: found[name] for name in self.names if name in found}


def _curves(
    outcome: Outcome, summaries: dict[str, RunSummary], findings: list[dict[str, str]]
) -> tuple[list[dict[str, Any]], list[pd.DataFrame]]:
    records, points = [], []

    def missing(curve: CurveOutcome, reason: str) -> None:
        known = [summaries[name].facts["quantity"] for name in curve.run_names if name in summaries]
        # without a recorded load there is no friction coefficient, so nothing is amiss
        severity = "suspect" if "friction_coefficient" in known else "note"
        severity = "error" if curve.crash else severity
        text, members = f"no measured curve: {reason}", "; ".join(curve.run_names)
        findings.append(
            {"severity": severity, "run": members, "where": curve.name, "message": text}
        )

    for curve in outcome.curves:
        if not curve.done:
            missing(curve, curve.reason)
            continue
        try:
            record, table = curve_record(Path(outcome.folder), curve)
        except Exception as error:  # recorded, as above
            findings.append(_error("; ".join(curve.run_names), curve.name, error))
            continue
        if not table["friction_coefficient"].notna().any():
            missing(curve, "no segment has both a speed and a friction coefficient")
            continue
        records.append(record)
        points.append(tables.labelled(table, "curve", curve.name, labels(curve)))
    return records, points


def _sliding(
    outcome: Outcome,
    readable: set[str],
    rows: dict[str, SurfaceRows],
    findings: list[dict[str, str]],
) -> tuple[list[dict[str, Any]], list[SlipFigure], list[pd.DataFrame]]:
    """Return the sliding modes, their figures and the rows of the table on stick-slip."""
    found: list[sliding.CurveSlip] = []
    for curve in outcome.curves:
        if curve.name not in readable:
            continue
        try:
            found.append(sliding.read_slip(outcome, curve))
        except Exception as error:  # recorded, as above
            findings.append(_error("; ".join(curve.run_names), f"stick-slip {curve.name}", error))
    if not found:
        return [], [], []
    table = sliding.sliding_tables(found, outcome)
    try:
        modes = sliding.judge_modes(found, outcome, rows)
        records = [sliding.mode_record(one, modes[one.outcome.name]) for one in found]
        return records, plan_sliding_figures(found, outcome), table
    except Exception as error:  # recorded, as above
        findings.append(_error("", "sliding mode", error))
        return [], [], table


class _Figures:
    """Figures of several kinds in one queue, in work."""

    def __init__(
        self,
        planned: Mapping[str, tuple[Callable[[Any], dict[str, str]], Sequence[Any]]],
        executor: Executor | None,
    ) -> None:
        self.tasks = {kind: tasks for kind, (_, tasks) in planned.items()}
        queue = [(draw, task) for draw, tasks in planned.values() for task in tasks]
        self.count = len(queue)
        self.work = completed(executor, _draw, queue)

    def collect(
        self, tell: Progress, findings: list[dict[str, str]]
    ) -> dict[str, list[dict[str, str]]]:
        """Wait for them and return the records of each kind.

        Those that cannot be drawn are findings.
        """
        drawn: dict[str, dict[str, str]] = {}
        for number, ((_, task), future) in enumerate(self.work):
            error = future.exception()
            if error is None:
                drawn[task.file] = future.result()
            else:  # recorded, as above
                findings.append(_error("", f"figure {task.title}", error))
            tell("other figures", number + 1, self.count)
        return {
            kind: [drawn[task.file] for task in tasks if task.file in drawn]
            for kind, tasks in self.tasks.items()
        }


def _draw(job: tuple[Callable[[Any], dict[str, str]], Any]) -> dict[str, str]:
    draw, task = job
    return draw(task)


def _write_tables(
    outcome: Outcome,
    summaries: dict[str, RunSummary],
    points: list[pd.DataFrame],
    findings: pd.DataFrame,
) -> None:
    folder = Path(outcome.folder) / "tables"
    rows = [
        tables.labelled(summaries[run.name].table, "run", run.name, labels(run))
        for run in outcome.runs
        if run.name in summaries
    ]
    friction = ["run", *tables.LABELS, "segment", "sliding_speed_m_s", "friction_coefficient"]
    tables.write(tables.together(rows, friction), folder / "friction.csv")
    stribeck = ["curve", *tables.LABELS, "sliding_speed_m_s", "friction_coefficient"]
    tables.write(tables.together(points, stribeck), folder / "stribeck.csv")
    sources = pd.DataFrame(list(outcome.sources), columns=["file", "sha256", "bytes"])
    tables.write(sources, folder / "sources.csv")
    tables.write(findings, folder / "findings.csv")
    checks = {name: one.facts["checks"] for name, one in summaries.items()}
    tables.write(tables.checks_table(checks), folder / "checks.csv")
