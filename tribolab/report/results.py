"""Writing of a report: figures, tables, report.json and the page, from stored records."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.engine.stage import Progress, begun, silent
from tribolab.campaign.joint.stage import JointFits
from tribolab.campaign.modes import Modes
from tribolab.campaign.recorded import done_and_failed
from tribolab.core.untyped import Json
from tribolab.figures.spec import FigureSpec
from tribolab.records.part_records import CurveRecord, FigureRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import Notice
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.starts import starts_of
from tribolab.report.campaign_tables import write_checks, write_tables
from tribolab.report.document.decisions import curve_notices
from tribolab.report.document.document import brief_run, report_document, report_head, write_json
from tribolab.report.document.models import model_rows_of
from tribolab.report.document.parts import (
    reported_curve,
    reported_mode,
    reported_model,
    reported_surface,
    run_document,
)
from tribolab.report.figures.choice import Wanted
from tribolab.report.figures.stage import (
    SECTIONS,
    Figures,
    FigureTask,
    described_tasks,
    figure_task,
    key_of,
)
from tribolab.report.page.page import prepare_page, write_page
from tribolab.report.page.reviewing import review_data
from tribolab.report.page_figures.along import MAX_RUNS, Along, along_figures, along_of
from tribolab.report.page_figures.compared import comparisons
from tribolab.report.page_figures.contributions import contribution_figures
from tribolab.report.page_figures.curves import FrictionOverSpeed, card_figures, load_figures
from tribolab.report.page_figures.gather import Subject, begun_page_figures, figure_subjects
from tribolab.report.page_figures.loads import over_load_figures
from tribolab.report.page_figures.points import RunPoint, run_points
from tribolab.report.page_figures.shown import shown_figures
from tribolab.report.page_figures.starts import static_figures
from tribolab.report.page_figures.traction import traction_figures
from tribolab.report.tables import SEVERITIES

if TYPE_CHECKING:
    from tribolab.campaign.store.new_catalogue import Store
    from tribolab.campaign.store.outcome import OpenOutcome, Outcome
    from tribolab.records.parts import RunOutcome


def write_report(
    outcome: OpenOutcome,
    *,
    executor: Executor | None = None,
    progress: Progress | None = None,
    figures: Wanted = "all",
    pdf: bool = False,
) -> None:
    """Write the report of a campaign: report.html, report.json, figures and tables.

    Write ``report.html`` (one page that opens offline), ``report.json`` (the same numbers),
    ``figures/*.svg`` and ``tables/*`` from the records in the outcome's store.

    Parameters
    ----------
    outcome
        From `tribolab.campaign.pipeline.process`; its folder has the data files.
    executor
        Any `concurrent.futures.Executor` for drawing; without one figures are drawn here.
    progress
        Called as ``progress(stage, done, total)``.
    figures
        Figures to draw: ``"all"``, ``"curves"`` (measured curves only) or ``"none"``. The page
        itself draws traces of runs.
    pdf
        Whether to write figures also as PDF.

    Notes
    -----
    A figure that cannot be drawn gives a finding with severity "error"; the others are drawn.
    """
    folder, store = Path(outcome.folder), outcome.store
    for name in ("figures", "tables"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    report_progress = progress or silent

    curves = [entry.record for entry in store.all("curve", CurveRecord)]
    surfaces = [entry.record for entry in store.all("surface", SurfaceRecord)]
    models = [entry.record for entry in store.all("model", ModelRecord)]
    briefs, notices, points, along = _summarise_runs(outcome)
    findings = _part_notices(outcome, surfaces, models) + notices
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
    subjects = figure_subjects(outcome, shown, list(rows.values()), modes, fitted)
    making = begun_page_figures(subjects, store, executor)
    # in the meantime, workers make the figures
    write_tables(outcome, shown, surfaces, rows)
    prepare_page()
    records, undrawn = making()
    findings += undrawn
    bands = {name: band for record in records for name, band in record.bands.items()}
    names = tuple(surface.name for surface in outcome.surfaces)
    by_curve = {row.model.curve: row for row in rows.values()}
    known = FrictionOverSpeed(shown, points, by_curve, bands, names)
    curve_specs = [*card_figures(known), *comparisons(known), *traction_figures(known)]
    on_screen = [*curve_specs, *over_load_figures(known), *along, *contribution_figures(shown)]
    live = [*shown_figures(on_screen), *(one for record in records for one in record.figures)]
    tasks = _figures([*curve_specs, *load_figures(known)], subjects, store, figures, pdf)
    drawn: dict[str, list[FigureRecord]] = {section: [] for section in SECTIONS}
    for record in begun(Figures(store, tasks), executor, report_progress)():
        if isinstance(record, Notice):
            findings.append(record)
            continue
        for figure in record.figures:
            drawn[key_of(figure)].append(figure)

    ordered = sorted(findings, key=lambda finding: SEVERITIES.index(finding.severity))
    write_checks(outcome, ordered, folder)
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
    write_json(document, _run_documents(outcome), folder / "report.json")
    on_page = document | {"runs": briefs, "review": review_data(outcome.campaign, briefs)}
    write_page(on_page, folder, lambda: _run_documents(outcome), store, live, points)
    store.save()
    report_progress("page", 1, 1)


def _figures(
    curves: Sequence[FigureSpec],
    subjects: Sequence[Subject],
    store: Store,
    wanted: Wanted,
    pdf: bool,
) -> list[FigureTask]:
    """Return a task for each figure that is drawn into files."""
    if wanted == "none":
        return []
    tasks = described_tasks([spec for spec in curves if spec.series], store, pdf=pdf)
    if wanted == "curves":
        return tasks
    return tasks + [
        figure_task(one.name, one.make, one.shaping, one.files, store, pdf=pdf) for one in subjects
    ]


def _run_documents(outcome: Outcome) -> Iterator[Json]:
    """Yield the entry of each run in report.json."""
    for entry in outcome.store.all("run", RunRecord):
        yield run_document(entry.record)


def _summarise_runs(
    outcome: Outcome,
) -> tuple[list[Json], list[Notice], dict[str, list[RunPoint]], list[FigureSpec]]:
    """Return short entries, notices and points of all runs, and figures of friction along runs."""
    briefs: list[Json] = []
    notices: list[Notice] = []
    points: dict[str, list[RunPoint]] = {}
    settled: list[Along] = []
    shown: list[RunRecord] = []
    count = 0
    for entry in outcome.store.all("run", RunRecord):
        briefs.append(brief_run(run_document(entry.record)))
        notices += entry.record.notices
        name = entry.record.outcome.name
        facts = entry.record.facts
        run = entry.record.outcome
        filed = dict(zip(run.measured_levels, run.load_levels, strict=True))
        points[name] = run_points(name, facts.segments, facts.offset, filed)
        if (of_run := along_of(entry.record)) is not None:
            count += 1
            settled += [of_run] * (len(settled) < MAX_RUNS)
        shown += [entry.record] * bool(len(shown) < MAX_RUNS and starts_of(entry.record))
    return briefs, notices, points, [*along_figures(settled, count), *static_figures(shown)]


def _part_notices(
    outcome: Outcome, surfaces: Sequence[SurfaceRecord], models: Sequence[ModelRecord]
) -> list[Notice]:
    """Return notices on the campaign, its media, failed runs, surfaces and models."""
    note = outcome.campaign.campaign.note
    findings = [Notice("note", "", "campaign", note)] if note else []
    findings += [
        Notice("suspect", "", f"medium {name}", text)
        for name, text in outcome.campaign.contradicting_viscosities().items()
    ]
    findings += [_failure(run) for run in outcome.runs if not run.done]
    findings += [Notice("fail", run.name, "run", run.kept) for run in outcome.runs if run.kept]
    findings += [Notice("fail", "", "decision", lost) for lost in outcome.lost_decisions]
    text = "excluded from the measured curves because a check failed; its own numbers are shown"
    findings += [
        Notice("note", run.name, "curves", text)
        for run in outcome.runs
        if run.quality in ("fail", "error")
    ]
    notices = [(f"surface {part.outcome.name}", part.outcome.findings) for part in surfaces]
    notices += [
        (f"model {part.outcome.name.removeprefix('model_')}", part.outcome.findings)
        for part in models
    ]
    findings += [Notice(f.severity, "", where, f.message) for where, of in notices for f in of]
    return findings


def _failure(run: RunOutcome) -> Notice:
    return Notice("fail", run.name, "run", run.reason or run.error or "no reason was given")


def shown_curves(
    curves: Sequence[CurveRecord], quantities: Mapping[str, str | None]
) -> tuple[list[CurveRecord], list[Notice]]:
    """Return the curves with a friction coefficient, and a notice for every curve without one."""
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
        # a missing curve is suspect only if some run has a load, and hence a friction coefficient
        known = [quantities.get(name) for name in outcome.run_names]
        severity = "suspect" if "friction_coefficient" in known else "note"
        severity = "error" if outcome.crash else severity
        missing.append(Notice(severity, members, outcome.name, f"no measured curve: {reason}"))
    return shown, missing
