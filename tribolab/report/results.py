"""Write the report of a campaign: figures, tables, report.json and the page, from its records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from tribolab.campaign.engine.stage import Progress, perform, silent
from tribolab.campaign.joint import JointFits
from tribolab.campaign.modes import Modes
from tribolab.records.joint_record import (
    JointRecord,
    comparison_table_rows,
    parameter_table_rows,
)
from tribolab.records.mode_record import ModeRecord
from tribolab.records.part_records import CurveRecord, FigureRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import Notice, Row
from tribolab.records.run_record import RunRecord
from tribolab.records.surface_rows import ADHESION, CONTACT, ROUGHNESS
from tribolab.report import tables
from tribolab.report.document import decisions
from tribolab.report.document.document import (
    brief_run,
    labels,
    report_document,
    report_head,
    write_json,
)
from tribolab.report.document.models import (
    ModelRow,
    curve_table,
    model_rows_of,
    sensitivity_table,
    shear_stress_table,
)
from tribolab.report.document.parts import (
    reported_curve,
    reported_mode,
    reported_model,
    reported_surface,
    run_document,
)
from tribolab.report.document.surfaces import table
from tribolab.report.figures.choice import Wanted
from tribolab.report.figures.curves import draw_curves, plan_figures
from tribolab.report.figures.models import draw_model, plan_model_figures
from tribolab.report.figures.sliding import draw_sliding, plan_sliding_figures
from tribolab.report.figures.stage import Figures, FigureTask, planned
from tribolab.report.figures.surfaces import draw_surfaces, plan_surface_figures
from tribolab.report.live.gather import live_figures
from tribolab.report.live.points import RunPoint, run_points
from tribolab.report.page.page import write_page
from tribolab.report.page.reviewing import review_data
from tribolab.untyped import Json

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import OpenOutcome, Outcome
    from tribolab.records.parts import RunOutcome

SECTIONS = ("figures", "surface_figures", "model_figures", "sliding_figures")


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
    briefs, said, points = _runs(outcome)
    findings = _of_parts(outcome, surfaces, models) + said
    shown, missing = shown_curves(curves, {run["name"]: run["quantity"] for run in briefs})
    findings += missing
    findings += [note for curve in shown for note in decisions.curve_notices(curve)]
    modes, unjudged = _modes(outcome, curves, surfaces, models, executor)
    findings += unjudged
    joints = perform(JointFits(outcome.campaign, curves, models, store), executor)
    findings += [
        Notice("note", "", f"joint fit of {joint.surface} in {joint.medium}", joint.reason)
        for joint in joints
        if not joint.done
    ]
    fitted = [joint for joint in joints if joint.done]

    rows = model_rows_of(models)
    live, undrawn = live_figures(outcome, shown, points, rows, modes, fitted, executor)
    findings += undrawn
    tasks: list[FigureTask] = []
    if figures != "none":
        tasks += planned(
            "figures",
            plan_figures([curve.outcome for curve in shown]),
            draw_curves,
            store,
            pdf=pdf,
        )
    if figures == "all":
        done = [surface.outcome for surface in surfaces if surface.rows is not None]
        known = [curve.outcome for curve in shown]
        surfaced = plan_surface_figures(done)
        tasks += planned("surface_figures", surfaced, draw_surfaces, store, pdf=pdf)
        modelled = plan_model_figures(outcome, list(rows.values()), fitted)
        tasks += planned("model_figures", modelled, draw_model, store, pdf=pdf)
        sliding = plan_sliding_figures(known, modes, outcome)
        tasks += planned("sliding_figures", sliding, draw_sliding, store, pdf=pdf)
    drawn: dict[str, list[FigureRecord]] = {section: [] for section in SECTIONS}
    for section, record in perform(Figures(tasks, store), executor, tell):
        if isinstance(record, Notice):
            findings.append(record)
        elif record is not None:
            drawn[section].append(record)

    ordered = sorted(findings, key=lambda finding: tables.SEVERITIES.index(finding.severity))
    _write_tables(outcome, shown, surfaces, rows, fitted, ordered)
    named = {surface.outcome.name: surface.rows for surface in surfaces}
    head = report_head(
        outcome,
        briefs,
        ordered,
        curves=map(reported_curve, shown),
        surfaces=(reported_surface(one, named.get(one.name)) for one in outcome.surfaces),
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


def _documents(outcome: Outcome) -> Iterator[Json]:
    """Give the runs as report.json has them, one after the other."""
    for entry in outcome.store.all("run", RunRecord):
        yield run_document(entry.record)


def _runs(
    outcome: Outcome,
) -> tuple[list[Json], list[Notice], dict[str, list[RunPoint]]]:
    """Return what is brief of every run, what is said of it, and its friction over speed."""
    briefs: list[Json] = []
    said: list[Notice] = []
    points: dict[str, list[RunPoint]] = {}
    for entry in outcome.store.all("run", RunRecord):
        briefs.append(brief_run(run_document(entry.record)))
        said += entry.record.notices
        name = entry.record.outcome.name
        facts = entry.record.facts
        points[name] = run_points(name, facts.segments, facts.offset)
    return briefs, said, points


def _of_parts(
    outcome: Outcome, surfaces: Sequence[SurfaceRecord], models: Sequence[ModelRecord]
) -> list[Notice]:
    """Return what is said of the campaign, and of its parts as a whole."""
    note = outcome.campaign.campaign.note
    findings = [Notice("note", "", "campaign", note)] if note else []
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
    """Return the curves that can be shown, and why the others cannot."""
    shown, missing = [], []
    for curve in curves:
        outcome, reason = curve.outcome, curve.outcome.reason
        if outcome.done:
            if any(row["friction_coefficient"] is not None for row in curve.points):
                shown.append(curve)
                continue
            reason = "no segment has both a speed and a friction coefficient"
        # without a recorded load there is no friction coefficient, so nothing is amiss
        known = [quantities.get(name) for name in outcome.run_names]
        severity = "suspect" if "friction_coefficient" in known else "note"
        severity = "error" if outcome.crash else severity
        members = "; ".join(outcome.run_names)
        missing.append(Notice(severity, members, outcome.name, f"no measured curve: {reason}"))
    return shown, missing


def _modes(
    outcome: OpenOutcome,
    curves: Sequence[CurveRecord],
    surfaces: Sequence[SurfaceRecord],
    models: Sequence[ModelRecord],
    executor: Executor | None,
) -> tuple[dict[str, ModeRecord], list[Notice]]:
    """Judge how the contacts slide; what could not be judged is a finding."""
    stage = Modes(outcome.campaign, curves, surfaces, models, outcome.store)
    answers = perform(stage, executor)
    modes, findings = {}, []
    for task, answer in zip(stage.plan(), answers, strict=True):
        if isinstance(answer, ModeRecord):
            modes[task.curve.name] = answer
        else:
            members = "; ".join(task.curve.run_names)
            where = f"stick-slip {task.curve.name}"
            findings.append(Notice("error", members, where, answer))
    return modes, findings


def _write_tables(
    outcome: Outcome,
    curves: Sequence[CurveRecord],
    surfaces: Sequence[SurfaceRecord],
    models: Mapping[str, ModelRow],
    joints: Sequence[JointRecord],
    findings: Sequence[Notice],
) -> None:
    folder = Path(outcome.folder) / "tables"
    store = outcome.store
    in_curves = {name for curve in curves for name in curve.outcome.run_names}

    def records() -> Iterator[RunRecord]:
        return (entry.record for entry in store.all("run", RunRecord))

    def labelled(what: str, name: str, part: Any, rows: Iterable[Row]) -> Iterator[Row]:
        named: Row = {what: name}
        return (named | labels(part) | row for row in rows)

    def friction() -> Iterator[Row]:
        for record in records():
            run = record.outcome
            yield from labelled("run", run.name, run, record.facts.segments)

    def stick_slip() -> Iterator[Row]:
        for record in records():
            run = record.outcome
            if run.name in in_curves:
                yield from labelled("run", run.name, run, record.slip)

    def static_friction() -> Iterator[Row]:
        for record in records():
            run = record.outcome
            yield from labelled("run", run.name, run, record.starts)

    def stribeck() -> Iterator[Row]:
        for curve in curves:
            yield from labelled("curve", curve.outcome.name, curve.outcome, curve.points)

    def budget() -> Iterator[Row]:
        for curve in curves:
            yield from labelled("curve", curve.outcome.name, curve.outcome, curve.budget)

    def checks() -> Iterator[Row]:
        for record in records():
            for row in record.facts.checks:
                columns = ("check", "variable", "status", "value", "unit", "message")
                yield {"run": record.outcome.name} | {k: getattr(row, k) for k in columns}

    first = [*tables.LABELS, "segment", "sliding_speed_m_s", "friction_coefficient"]
    tables.write_rows(friction, folder / "friction.csv", ["run", *first])
    tables.write_rows(stick_slip, folder / "stick_slip.csv", ["run", "segment"])
    tables.write_rows(static_friction, folder / "static_friction.csv", ["run", "segment"])
    first = ["curve", *tables.LABELS, "sliding_speed_m_s", "friction_coefficient"]
    tables.write_rows(stribeck, folder / "stribeck.csv", first)
    first = ["curve", *tables.LABELS, "sliding_speed_m_s", "part", "contribution", "share", "dof"]
    tables.write_rows(budget, folder / "uncertainty_budget.csv", first)
    first = ["run", "check", "variable", "status", "value", "unit", "message"]
    tables.write_rows(checks, folder / "checks.csv", first)
    decisions.write_tables(outcome, curves, folder)
    columns = ["file", "sha256", "bytes"]
    tables.write(pd.DataFrame(list(outcome.sources), columns=columns), folder / "sources.csv")
    tables.write(tables.findings_table(findings), folder / "findings.csv")
    rows = [surface.rows for surface in surfaces if surface.rows is not None]
    for name, wanted in (("roughness", ROUGHNESS), ("contact", CONTACT), ("adhesion", ADHESION)):
        tables.write(table(rows, name, wanted), folder / f"{name}.csv")
    if outcome.models:
        every = list(models.values())
        for name, made in (
            ("shear_stress", shear_stress_table(every)),
            ("stribeck_model", curve_table(every)),
            ("model_sensitivity", sensitivity_table(every)),
        ):
            tables.write(made, folder / f"{name}.csv")
    if joints:
        tables.write(pd.DataFrame(parameter_table_rows(joints)), folder / "joint_fit.csv")
        compared = pd.DataFrame(comparison_table_rows(joints))
        tables.write(compared, folder / "model_comparison.csv")
