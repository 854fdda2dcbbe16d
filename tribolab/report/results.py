"""Write the report of a campaign: figures, tables, report.json and the page, from its records."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.engine.stage import Progress, begun, silent
from tribolab.campaign.joint.stage import JointFits
from tribolab.campaign.modes import Modes
from tribolab.campaign.recorded import done_and_failed
from tribolab.figures.spec import FigureSpec
from tribolab.records.joint_record import JointRecord
from tribolab.records.mode_record import ModeRecord
from tribolab.records.part_records import CurveRecord, FigureRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import Notice
from tribolab.records.run_record import RunRecord
from tribolab.report.campaign_tables import write_findings, write_tables
from tribolab.report.document.decisions import curve_notices
from tribolab.report.document.document import brief_run, report_document, report_head, write_json
from tribolab.report.document.models import ModelRow, model_rows_of
from tribolab.report.document.parts import (
    reported_curve,
    reported_mode,
    reported_model,
    reported_surface,
    run_document,
)
from tribolab.report.figures.choice import Wanted
from tribolab.report.figures.curves import draw_curves, plan_figures
from tribolab.report.figures.models import draw_model, plan_model_figures
from tribolab.report.figures.sliding import draw_sliding, plan_sliding_figures
from tribolab.report.figures.stage import Figures, FigureTask, planned
from tribolab.report.figures.surfaces import draw_surfaces, plan_surface_figures
from tribolab.report.live.along import MOST_RUNS, Strokes, along_figures, strokes_of
from tribolab.report.live.gather import begun_live_figures
from tribolab.report.live.points import RunPoint, run_points
from tribolab.report.page.page import prepare_page, write_page
from tribolab.report.page.reviewing import review_data
from tribolab.report.tables import SEVERITIES
from tribolab.untyped import Json

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import OpenOutcome, Outcome
    from tribolab.records.parts import CurveOutcome, RunOutcome

_SECTIONS = ("figures", "surface_figures", "model_figures", "sliding_figures")


def write_report(
    outcome: OpenOutcome,
    *,
    executor: Executor | None = None,
    progress: Progress | None = None,
    figures: Wanted = "all",
    pdf: bool = False,
) -> None:
    """Write everything that the results folder has beside the data.

    Writes ``report.html`` (one page that opens offline), ``report.json`` (the same numbers),
    ``figures/*.svg`` and ``tables/*``, all from the records in the outcome's store.

    Parameters
    ----------
    outcome
        From `tribolab.campaign.pipeline.process`; its folder has the data files.
    executor
        Any `concurrent.futures.Executor` for the drawing; without one it is done here.
    progress
        Called as ``progress(stage, done, total)``.
    figures
        Which are drawn: ``"all"``, ``"curves"`` (measured curves only) or ``"none"``. Traces of
        runs are drawn by the page itself.
    pdf
        Whether figures are written as PDF, too.

    Notes
    -----
    A figure that cannot be drawn is a finding of severity "error" and does not stop the rest.
    """
    folder, store = Path(outcome.folder), outcome.store
    for name in ("figures", "tables"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    tell = progress or silent

    curves = [entry.record for entry in store.all("curve", CurveRecord)]
    surfaces = [entry.record for entry in store.all("surface", SurfaceRecord)]
    models = [entry.record for entry in store.all("model", ModelRecord)]
    briefs, said, points, along = _runs(outcome)
    findings = _of_parts(outcome, surfaces, models) + said
    shown, missing = shown_curves(curves, {run["name"]: run["quantity"] for run in briefs})
    findings += missing
    findings += [note for curve in shown for note in curve_notices(curve)]
    fitting = begun(JointFits(outcome.campaign, curves, models, surfaces, store), executor)
    judging = begun(Modes(outcome.campaign, curves, surfaces, models, store), executor)
    judged, unjudged = done_and_failed(judging())
    modes = {mode.curve: mode for mode in judged}
    findings += unjudged
    joints = fitting()
    findings += [
        Notice("note", "", f"joint fit of {joint.surface} in {joint.medium}", joint.reason)
        for joint in joints
        if not joint.done
    ]
    fitted = [joint for joint in joints if joint.done]

    rows = model_rows_of(models)
    making = begun_live_figures(outcome, shown, points, along, rows, modes, fitted, executor)
    known = [curve.outcome for curve in shown]
    tasks = _figures(outcome, known, surfaces, rows, fitted, modes, figures, pdf)
    drawing = begun(Figures(store, tasks), executor, tell)
    # while workers draw
    write_tables(outcome, shown, surfaces, rows, fitted)
    prepare_page()
    live, undrawn = making()
    findings += undrawn
    drawn: dict[str, list[FigureRecord]] = {section: [] for section in _SECTIONS}
    for task, record in zip(tasks, drawing(), strict=True):
        if isinstance(record, Notice):
            findings.append(record)
        elif record is not None:
            drawn[task.section].append(record)

    ordered = sorted(findings, key=lambda finding: SEVERITIES.index(finding.severity))
    write_findings(ordered, folder)
    named = {surface.outcome.name: surface.rows for surface in surfaces}
    head = report_head(
        outcome,
        briefs,
        ordered,
        curves=map(reported_curve, shown),
        surfaces=(reported_surface(s, named.get(s.name)) for s in outcome.surfaces),
        modes=(reported_mode(modes[c.outcome.name], c) for c in shown if c.outcome.name in modes),
        models=(reported_model(model, rows.get(model.name)) for model in outcome.models),
        joints=joints,
        figures=drawn,
    )
    document = report_document(head)
    write_json(document, _documents(outcome), folder / "report.json")
    on_page = document | {"runs": briefs, "review": review_data(outcome.campaign, briefs)}
    write_page(on_page, folder, lambda: _documents(outcome), store, live)
    store.save()
    tell("page", 1, 1)


def _figures(
    outcome: OpenOutcome,
    curves: Sequence[CurveOutcome],
    surfaces: Sequence[SurfaceRecord],
    models: Mapping[str, ModelRow],
    fitted: Sequence[JointRecord],
    modes: Mapping[str, ModeRecord],
    wanted: Wanted,
    pdf: bool,
) -> list[FigureTask]:
    """Return the figures that are to be drawn."""
    store = outcome.store
    if wanted == "none":
        return []
    tasks = planned("figures", plan_figures(curves), draw_curves, store, pdf=pdf)
    if wanted == "curves":
        return tasks
    done = [surface.outcome for surface in surfaces if surface.rows is not None]
    surfaced = plan_surface_figures(done)
    tasks += planned("surface_figures", surfaced, draw_surfaces, store, pdf=pdf)
    modelled = plan_model_figures(outcome, list(models.values()), fitted)
    tasks += planned("model_figures", modelled, draw_model, store, pdf=pdf)
    sliding = plan_sliding_figures(curves, modes, outcome)
    return tasks + planned("sliding_figures", sliding, draw_sliding, store, pdf=pdf)


def _documents(outcome: Outcome) -> Iterator[Json]:
    """Give the runs as report.json has them, one after the other."""
    for entry in outcome.store.all("run", RunRecord):
        yield run_document(entry.record)


def _runs(
    outcome: Outcome,
) -> tuple[list[Json], list[Notice], dict[str, list[RunPoint]], list[FigureSpec]]:
    """Return what is brief of every run and said of it, its friction over speed and by strokes."""
    briefs: list[Json] = []
    said: list[Notice] = []
    points: dict[str, list[RunPoint]] = {}
    strokes: list[Strokes] = []
    count = 0
    for entry in outcome.store.all("run", RunRecord):
        briefs.append(brief_run(run_document(entry.record)))
        said += entry.record.notices
        name = entry.record.outcome.name
        facts = entry.record.facts
        run = entry.record.outcome
        filed = dict(zip(run.measured_levels, run.load_levels, strict=True))
        points[name] = run_points(name, facts.segments, facts.offset, filed)
        if (of_run := strokes_of(name, facts.segments)) is not None:
            count += 1
            strokes += [of_run] * (len(strokes) < MOST_RUNS)
    return briefs, said, points, along_figures(strokes, count)


def _of_parts(
    outcome: Outcome, surfaces: Sequence[SurfaceRecord], models: Sequence[ModelRecord]
) -> list[Notice]:
    """Return what is said of the campaign, and of its parts as a whole."""
    note = outcome.campaign.campaign.note
    findings = [Notice("note", "", "campaign", note)] if note else []
    findings += [
        Notice("suspect", "", f"medium {name}", text)
        for name, text in outcome.campaign.contradicting_viscosities().items()
    ]
    findings += [_failure(run) for run in outcome.runs if not run.done]
    findings += [Notice("fail", run.name, "run", run.kept) for run in outcome.runs if run.kept]
    findings += [Notice("fail", "", "decision", lost) for lost in outcome.lost_decisions]
    text = "left out of the measured curves, because its checks failed; its own numbers are shown"
    findings += [
        Notice("note", run.name, "curves", text)
        for run in outcome.runs
        if run.quality in ("fail", "error")
    ]
    said = [(f"surface {part.outcome.name}", part.outcome.findings) for part in surfaces]
    said += [
        (f"model {part.outcome.name.removeprefix('model_')}", part.outcome.findings)
        for part in models
    ]
    findings += [Notice(f.severity, "", where, f.message) for where, of in said for f in of]
    return findings


def _failure(run: RunOutcome) -> Notice:
    return Notice("fail", run.name, "run", run.reason or run.error or "no reason was given")


def shown_curves(
    curves: Sequence[CurveRecord], quantities: Mapping[str, str | None]
) -> tuple[list[CurveRecord], list[Notice]]:
    """Return the curves that can be shown, and what the others, or parts of them, lack."""
    shown, missing = [], []
    for curve in curves:
        outcome, reason = curve.outcome, curve.outcome.reason
        members = "; ".join(outcome.run_names)
        if curve.no_slip:
            text = f"no stick-slip over speed: {curve.no_slip}"
            missing.append(Notice("error", members, outcome.name, text))
        if outcome.done:
            if any(row["friction_coefficient"] is not None for row in curve.points):
                shown.append(curve)
                continue
            reason = "no segment has both a speed and a friction coefficient"
        # without a recorded load there is no friction coefficient, so nothing is amiss
        known = [quantities.get(name) for name in outcome.run_names]
        severity = "suspect" if "friction_coefficient" in known else "note"
        severity = "error" if outcome.crash else severity
        missing.append(Notice(severity, members, outcome.name, f"no measured curve: {reason}"))
    return shown, missing
