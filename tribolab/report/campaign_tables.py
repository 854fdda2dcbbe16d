"""CSV tables of a campaign: which are written, and with which rows and columns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pandas as pd

from tribolab.core.wording import duration, many
from tribolab.records.part_records import CurveRecord, SurfaceRecord, SurfaceRows
from tribolab.records.parts import Notice, Row
from tribolab.records.runs.notice_words import LEFT_OUT
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.surfaces.surface_rows import ADHESION, CONTACT
from tribolab.report import tables
from tribolab.report.document.document import labels
from tribolab.report.document.models import ModelRow, model_curve_table, shear_stress_table

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_CHECK = ("check", "variable", "status", "value", "unit", "message")
_POINT = (*tables.CURVE_LABELS, "sliding_speed_m_s", "friction_coefficient")
_PART = (*_POINT[:-1], "part", "varies", "contribution", "share", "dof")
_SEGMENT = (*tables.CURVE_LABELS, "segment", "sliding_speed_m_s", "friction_coefficient")

# name of each table and description of its content
TABLES = {
    "friction": "friction coefficient of every segment, with its errors",
    "stribeck": "measured friction over sliding speed",
    "uncertainty_budget": "parts of the uncertainty of every measured friction coefficient",
    "stick_slip": "stick-slip of every segment",
    "running_in": "running-in, steady and mean friction of every run at one speed",
    "static_friction": "static friction at every start of sliding",
    "roughness": "roughness of the surfaces",
    "contact": "contact area and separation over load",
    "adhesion": "contact area with adhesion",
    "shear_stress": "shear stresses fitted to the measured curves",
    "stribeck_model": "computed friction over sliding speed",
    "sources": "raw files with their SHA-256, and what was left out of their runs",
    "checks": "findings, the gravest first, and the result of every check of every run",
    "decisions": "what a person decided on runs",
}

# columns of a segment that friction.csv omits, e.g. components of U95; report.json has them
_NOT_IN_FRICTION = frozenset(
    (
        *("friction_coefficient_u", "friction_coefficient_dof", "friction_coefficient_beyond_dof"),
        *("friction_coefficient_beyond_sem", "friction_coefficient_level", "pair", "samples"),
        *("friction_force_std_N", "friction_force_sem_N", "normal_force_std_N"),
        *("normal_force_sem_N", "sliding_distance_m"),
        *("trend_p_value", "trend_1_s", "autocorrelation_time_s", "set_speed_m_s"),
        *("friction_coefficient_beyond_U95", "friction_coefficient_shared_sem"),
        *("friction_force_offset_N", "normal_force_offset_N", "tilt_found_rad"),
        *("trimmed_start_s", "trimmed_stop_s"),
    )
)
_NOT_IN_CURVE = frozenset(("friction_coefficient_within",))
_ROUGHNESS = (
    *("scans", "Ra_m", "Rq_m", "Rz_m", "Rsk", "Rku", "Rdq", "Ra_sem_m", "Rq_sem_m"),
    *("rms_roughness_m", "rms_roughness_low_m", "rms_roughness_high_m"),
    *("rms_slope", "rms_slope_low", "rms_slope_high", "hurst_exponent"),
    *("wavenumber_low_1_m", "wavenumber_high_1_m", "form_removed", "lambda_c_m"),
)
_SLIP = (
    *("segment", "sliding_speed_m_s", "waveform", "class_probability", "dominant_frequency_Hz"),
    *("dominant_wavelength_m", "drop", "stick_duration_s", "slip_duration_s"),
    *("recurrence_distance_m", "events", "mains_amplitude"),
    *("loading_stiffness_N_m", "sample_noise", "remark"),
)


def friction_row(row: Row) -> Row:
    """Return the columns of a segment for friction.csv, with half_loop_N only if µ is unknown.

    Parameters
    ----------
    row
        Row of the segment in report.json.
    """
    left = _NOT_IN_FRICTION
    if row.get("friction_coefficient") is not None:
        left = left | {"half_loop_N"}
    return {name: value for name, value in row.items() if name not in left}


class _LongTable(NamedTuple):
    """Table that is written row by row, to save memory; no file without rows and columns."""

    file: str
    rows: Callable[[], Iterator[Row]]
    columns: Sequence[str] = ()


def write_tables(
    outcome: Outcome,
    curves: Sequence[CurveRecord],
    surfaces: Sequence[SurfaceRecord],
    models: Mapping[str, ModelRow],
) -> None:
    """Write all tables of a campaign except those of findings and checks.

    Friction tables are written if there are runs, roughness if there are scans, and tables of
    contact and adhesion if the campaign file defines a contact.

    Parameters
    ----------
    outcome
        Outcome of the campaign; its store has the runs.
    curves
        Curves to show.
    surfaces, models
        Records of the surfaces, and rows of the models.
    """
    folder = Path(outcome.folder) / "tables"
    for long in _long_tables(outcome, curves):
        tables.write_rows(long.rows, folder / long.file, long.columns)
    short = {"sources": _sources(outcome)}
    rows = [surface.rows for surface in surfaces if surface.rows is not None]
    of_surfaces: dict[str, tuple[Iterable[str], Callable[[SurfaceRows], Iterable[Row]]]] = {
        "roughness": (_ROUGHNESS, lambda surface: [surface.roughness]),
        "contact": (CONTACT, lambda surface: surface.contact),
        "adhesion": (ADHESION, lambda surface: surface.adhesion),
    }
    for name, (wanted, of) in of_surfaces.items():
        if not any(surface.files for surface in outcome.surfaces):
            break
        named = [{"surface": s.name, "quality": s.quality, **row} for s in rows for row in of(s)]
        if not named and all(surface.done for surface in outcome.surfaces):
            continue  # no contact is defined
        short[name] = pd.DataFrame(named, columns=["surface", "quality", *wanted])
    if outcome.models:
        every = list(models.values())
        short["shear_stress"] = shear_stress_table(every)
        short["stribeck_model"] = model_curve_table(every)
    for name, made in short.items():
        tables.write_csv(made, folder / f"{name}.csv")


def _sources(outcome: Outcome) -> pd.DataFrame:
    """Return the table of raw files: checksum, run, and the parts left out, with reasons."""
    by_file: dict[str, tuple[str, str]] = {}
    for entry in outcome.store.all("run", RunRecord):
        run = entry.record.outcome
        parts = (
            f"{part.reason}: {many(part.intervals, 'interval')}, {duration(part.duration_s)}"
            for part in entry.record.facts.omitted
            if part.duration_s is not None
        )
        by_file |= dict.fromkeys(run.files, (run.name, "; ".join(parts)))
    rows = [(*source, *by_file.get(source[0], ("", ""))) for source in outcome.sources]
    return pd.DataFrame(rows, columns=["file", "sha256", "bytes", "run", "left_out"])


def write_checks(outcome: Outcome, findings: Sequence[Notice], folder: Path) -> None:
    """Write checks.csv: the findings, most severe first, then every check of every run.

    A finding that repeats a check is not listed twice. Omitted parts of runs are in sources.csv.

    Parameters
    ----------
    outcome
        Outcome of the campaign; its store has the runs.
    findings
        Findings in the order of writing.
    folder
        Results folder.
    """
    checked = {
        (entry.record.outcome.name, f"{row.check} {row.variable}".strip())
        for entry in outcome.store.all("run", RunRecord)
        for row in entry.record.facts.checks
    }
    cures: dict[tuple[str, str], list[str]] = {}
    own: list[Notice] = []
    for finding in findings:
        place = finding.run, finding.where
        if place in checked:
            cures.setdefault(place, []).append(finding.message)
        elif finding.where != LEFT_OUT:
            own.append(finding)

    def every() -> Iterator[Row]:
        for each in own:
            values = (each.run, each.where, "", each.severity, None, "", each.message)
            yield dict(zip(("run", *_CHECK), values, strict=True))
        for entry in outcome.store.all("run", RunRecord):
            name = entry.record.outcome.name
            for row in entry.record.facts.checks:
                cure_texts = cures.get((name, f"{row.check} {row.variable}".strip()), ())
                full = [text for text in cure_texts if row.message in text]
                made: Row = {"run": name} | {key: getattr(row, key) for key in _CHECK}
                yield made | {"message": full[0] if full else row.message}

    tables.write_rows(every, folder / "tables" / "checks.csv", ("run", *_CHECK))


def _long_tables(outcome: Outcome, curves: Sequence[CurveRecord]) -> Iterator[_LongTable]:
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

    def slip() -> Iterator[Row]:
        for entry in outcome.store.all("run", RunRecord):
            name = entry.record.outcome.name
            for row in entry.record.slip if name in in_curves else ():
                kept: Row = {"run": name}
                yield kept | {key: row[key] for key in _SLIP if key in row}

    def segments(record: RunRecord) -> Iterable[Row]:
        return (friction_row(row) for row in record.facts.segments)

    def points(record: CurveRecord) -> Iterable[Row]:
        for row in record.points:
            yield {name: value for name, value in row.items() if name not in _NOT_IN_CURVE}

    if outcome.campaign.run:
        yield _LongTable("friction.csv", of_runs(segments), ("run", *_SEGMENT))
        yield _LongTable("stick_slip.csv", slip, ("run", "segment"))
        yield _LongTable("static_friction.csv", of_runs(lambda run: run.starts), ("run", "segment"))
        settled = of_runs(lambda run: (each.row() for each in run.facts.running_in))
        yield _LongTable("running_in.csv", settled)
        yield _LongTable("stribeck.csv", of_curves(points), ("curve", *_POINT))
        parts = of_curves(lambda curve: curve.budget)
        yield _LongTable("uncertainty_budget.csv", parts, ("curve", *_PART))
    decided = of_runs(lambda run: (decision.row() for decision in run.facts.decisions))
    yield _LongTable("decisions.csv", decided)
