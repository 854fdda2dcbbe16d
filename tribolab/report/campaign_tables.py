"""All tables of a campaign: what is in them, in which file, with which columns first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pandas as pd

from tribolab.records.models.joint_record import (
    JointRecord,
    comparison_table_rows,
    parameter_table_rows,
)
from tribolab.records.part_records import CurveRecord, SurfaceRecord, SurfaceRows
from tribolab.records.parts import Notice, Row
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.surfaces.surface_rows import ADHESION, CONTACT, ROUGHNESS
from tribolab.records.wording import plain_value
from tribolab.report import tables
from tribolab.report.document.decisions import CURVES_AS_FOUND
from tribolab.report.document.document import labels
from tribolab.report.document.models import (
    ModelRow,
    model_curve_table,
    sensitivity_table,
    shear_stress_table,
)

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_CHECK = ("check", "variable", "status", "value", "unit", "message")
_POINT = (*tables.CURVE_LABELS, "sliding_speed_m_s", "friction_coefficient")
_PART = (
    *tables.CURVE_LABELS,
    "sliding_speed_m_s",
    "part",
    "varies",
    "contribution",
    "share",
    "dof",
)
_SEGMENT = (*tables.CURVE_LABELS, "segment", "sliding_speed_m_s", "friction_coefficient")


# All that may be written, with what they say.
TABLES = {
    "friction": "friction coefficient of every segment, with its errors",
    "stribeck": "measured friction over sliding speed",
    "stribeck_as_found": "measured friction over sliding speed, without a person's decisions",
    "uncertainty_budget": "parts of the uncertainty of every measured friction coefficient",
    "stick_slip": "stick-slip of every segment",
    "running_in": "running-in, steady and mean friction of every run at one speed",
    "static_friction": "static friction at every start of sliding",
    "roughness": "roughness of the surfaces",
    "contact": "contact area and separation over load",
    "adhesion": "contact area with adhesion",
    "shear_stress": "shear stresses fitted to the measured curves",
    "stribeck_model": "computed friction over sliding speed",
    "model_sensitivity": "how far what is not known moves the computed friction",
    "joint_fit": "parameters fitted to all loads of a surface in one liquid at once",
    "model_comparison": "models that were fitted to all loads at once, compared",
    "sources": "raw files with their SHA-256",
    "checks": "what every check said of every run",
    "findings": "what a reader should know",
    "decisions": "what a person decided on runs",
}


# Of a segment, what the run's data file has and no reader of tables needs: parts of the error that
# U95 includes, and numbers that follow from others.
_NOT_IN_FRICTION = frozenset(
    (
        *("friction_coefficient_u", "friction_coefficient_dof", "friction_coefficient_beyond_dof"),
        *("friction_coefficient_beyond_sem", "friction_coefficient_level", "pair", "samples"),
        *("friction_force_std_N", "friction_force_sem_N", "normal_force_std_N"),
        *("normal_force_sem_N", "sliding_distance_m"),
        *("trend_p_value", "trend_1_s"),
    )
)
_SLIP = (
    *("segment", "sliding_speed_m_s", "waveform", "class_probability", "dominant_frequency_Hz"),
    *("dominant_wavelength_m", "drop", "stick_duration_s", "slip_duration_s"),
    *("recurrence_distance_m", "events", "mains_frequency_Hz", "mains_amplitude"),
    *("loading_stiffness_N_m", "sample_noise", "remark"),
)


def friction_row(row: Row) -> Row:
    """Return what `friction.csv` has of a segment; the half loop only if there is no coefficient.

    Parameters
    ----------
    row
        Of report.json.
    """
    left = _NOT_IN_FRICTION
    if row.get("friction_coefficient") is not None:
        left = left | {"half_loop_N"}
    return {name: value for name, value in row.items() if name not in left}


class _Long(NamedTuple):
    """A table that is never in memory as a whole.

    Parameters
    ----------
    file
        Its name.
    rows
        Gives its rows, as often as it is called.
    columns
        What it has without rows; with none of either it is not written.
    """

    file: str
    rows: Callable[[], Iterator[Row]]
    columns: Sequence[str] = ()


def write_tables(
    outcome: Outcome,
    curves: Sequence[CurveRecord],
    surfaces: Sequence[SurfaceRecord],
    models: Mapping[str, ModelRow],
    joints: Sequence[JointRecord],
) -> None:
    """Write all tables of a campaign but that of its findings.

    Without runs there are none of friction, without scans none of surfaces, and
    where no contact is asked about none of contact and adhesion.

    Parameters
    ----------
    outcome
        Its store has the runs.
    curves
        Those that are shown.
    surfaces, models, joints
        What is recorded of them; of joint fits those that were done.
    """
    folder = Path(outcome.folder) / "tables"
    for long in _long_tables(outcome, curves):
        tables.write_rows(long.rows, folder / long.file, long.columns)
    columns = ["file", "sha256", "bytes"]
    short = {"sources": pd.DataFrame(list(outcome.sources), columns=columns)}
    rows = [surface.rows for surface in surfaces if surface.rows is not None]
    of_surfaces: dict[str, tuple[Iterable[str], Callable[[SurfaceRows], Iterable[Row]]]] = {
        "roughness": (ROUGHNESS, lambda surface: [surface.roughness]),
        "contact": (CONTACT, lambda surface: surface.contact),
        "adhesion": (ADHESION, lambda surface: surface.adhesion),
    }
    for name, (wanted, of) in of_surfaces.items():
        if not any(surface.files for surface in outcome.surfaces):
            break
        named = [{"surface": s.name, "quality": s.quality, **row} for s in rows for row in of(s)]
        if not named and all(surface.done for surface in outcome.surfaces):
            continue  # no contact was asked about
        short[name] = pd.DataFrame(named, columns=["surface", "quality", *wanted])
    if outcome.models:
        every = list(models.values())
        short["shear_stress"] = shear_stress_table(every)
        short["stribeck_model"] = model_curve_table(every)
        short["model_sensitivity"] = sensitivity_table(every)
    if joints:
        short["joint_fit"] = pd.DataFrame(parameter_table_rows(joints))
        short["model_comparison"] = pd.DataFrame(comparison_table_rows(joints))
    for name, made in short.items():
        tables.write_csv(made, folder / f"{name}.csv")


def write_findings(findings: Iterable[Notice], folder: Path) -> None:
    """Write the table of findings of a results folder, the gravest first."""
    tables.write_csv(tables.findings_table(findings), folder / "tables" / "findings.csv")


def _saying(says: str, rows: Iterable[Row]) -> Iterator[Row]:
    """Give rows with what their uncertainties do not hold."""
    return (row | {"uncertainty_says": says} for row in rows)


def _long_tables(outcome: Outcome, curves: Sequence[CurveRecord]) -> Iterator[_Long]:
    in_curves = {name for curve in curves for name in curve.outcome.run_names}

    def of_runs(rows: Callable[[RunRecord], Iterable[Row]]) -> Callable[[], Iterator[Row]]:
        def every() -> Iterator[Row]:
            for entry in outcome.store.all("run", RunRecord):
                run = entry.record.outcome
                named: Row = {"run": run.name, **labels(run)}
                yield from (named | row for row in rows(entry.record))

        return every

    def of_curves(rows: Callable[[CurveRecord], Iterable[Row]]) -> Callable[[], Iterator[Row]]:
        def every() -> Iterator[Row]:
            for curve in curves:
                named: Row = {"curve": curve.outcome.name, **labels(curve.outcome)}
                yield from (named | row for row in rows(curve))

        return every

    def checks() -> Iterator[Row]:
        for entry in outcome.store.all("run", RunRecord):
            for row in entry.record.facts.checks:
                yield {"run": entry.record.outcome.name} | {k: getattr(row, k) for k in _CHECK}

    def slip(record: RunRecord) -> Iterable[Row]:
        shown = record.slip if record.outcome.name in in_curves else ()
        return ({name: row[name] for name in _SLIP if name in row} for row in shown)

    def segments(record: RunRecord) -> Iterable[Row]:
        return (friction_row(row) for row in record.facts.segments)

    def points(record: CurveRecord) -> Iterable[Row]:
        return _saying(record.uncertainty_says, record.points)

    if outcome.campaign.run:
        yield _Long("friction.csv", of_runs(segments), ("run", *_SEGMENT))
        yield _Long("stick_slip.csv", of_runs(slip), ("run", "segment"))
        yield _Long("static_friction.csv", of_runs(lambda run: run.starts), ("run", "segment"))
        settled = of_runs(lambda run: (each.row() for each in run.facts.running_in))
        yield _Long("running_in.csv", settled)
        yield _Long("stribeck.csv", of_curves(points), ("curve", *_POINT))
        parts = of_curves(lambda curve: curve.budget)
        yield _Long("uncertainty_budget.csv", parts, ("curve", *_PART))
        yield _Long("checks.csv", checks, ("run", *_CHECK))
    decided = of_runs(lambda run: (decision.row() for decision in run.facts.decisions))
    yield _Long("decisions.csv", decided)

    def as_found(record: CurveRecord) -> Iterable[Row]:
        return _saying(record.uncertainty_says, map(plain_value, record.points_as_found))

    yield _Long(CURVES_AS_FOUND, of_curves(as_found))
