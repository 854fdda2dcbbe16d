"""Entries of report.json for runs, curves, surfaces, models and sliding modes."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING

from pydantic import TypeAdapter

from tribolab.core.wording import load_label
from tribolab.records.parts import PartOutcome
from tribolab.report.document.schema import (
    ReportedCurve,
    ReportedMode,
    ReportedModel,
    ReportedRun,
    ReportedSurface,
)

if TYPE_CHECKING:
    from tribolab.core.untyped import Arguments, Json
    from tribolab.records.models.mode_record import ModeRecord
    from tribolab.records.part_records import CurveRecord, SurfaceRows
    from tribolab.records.parts import ModelOutcome, SurfaceOutcome
    from tribolab.records.runs.run_record import RunRecord
    from tribolab.report.document.models import ModelRow

_RUN = TypeAdapter(ReportedRun)


def run_document(record: RunRecord) -> Json:
    """Return the entry of a run in report.json as plain data."""
    run = record.outcome
    reported = ReportedRun(
        **_part(run),
        surface=run.surface,
        medium=run.medium,
        nominal_normal_force_N=load_label(run.normal_force),
        load_from=run.load_from,
        files=run.files,
        segments_found=len(record.facts.segments),
        segments_rejected=run.segments_rejected,
        quality_as_found=run.quality_as_found,
        **vars(record.facts),
    )
    plain: Json = _RUN.dump_python(reported, mode="json", by_alias=True)
    return plain


def reported_curve(curve: CurveRecord) -> ReportedCurve:
    """Return the entry of a measured curve in report.json."""
    outcome = curve.outcome
    return ReportedCurve(
        outcome.name,
        outcome.surface,
        outcome.medium,
        outcome.normal_force,
        outcome.run_names,
        curve.points,
        curve.points_as_found,
        curve.budget,
        curve.uncertainty_says,
        outcome.load_from,
        curve.traction,
    )


def reported_surface(surface: SurfaceOutcome, rows: SurfaceRows | None) -> ReportedSurface:
    """Return the entry of a surface in report.json."""
    return ReportedSurface(
        **_part(surface),
        quality=surface.quality,
        checks=surface.checks,
        files=surface.files,
        roughness=rows.roughness if rows else None,
        contact=rows.contact if rows else (),
        adhesion=rows.adhesion if rows else (),
        modulus=rows.modulus if rows else "",
        validity=rows.validity if rows else "",
        area=rows.area if rows else "",
    )


def reported_model(model: ModelOutcome, rows: ModelRow | None) -> ReportedModel:
    """Return the entry of a mixed-lubrication model in report.json."""
    return ReportedModel(
        **_part(model),
        curve=model.curve,
        surface=model.surface,
        medium=model.medium,
        normal_force_N=model.normal_force,
        fit=rows.fit if rows else None,
        sensitivity=rows.sensitivity if rows else (),
        not_varied=rows.not_varied if rows else "",
        not_in_model=rows.not_in_model if rows else (),
        validity=rows.validity if rows else "",
    )


def reported_mode(mode: ModeRecord, curve: CurveRecord) -> ReportedMode:
    """Return the entry of the sliding mode of a curve in report.json."""
    outcome = curve.outcome
    shown = {name: value for name, value in vars(mode).items() if name != "moves"}
    return ReportedMode(
        **shown,
        surface=outcome.surface,
        medium=outcome.medium,
        nominal_normal_force_N=outcome.normal_force,
    )


def _part(outcome: PartOutcome) -> Arguments:
    return {field.name: getattr(outcome, field.name) for field in fields(PartOutcome)}
