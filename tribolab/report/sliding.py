"""What the report says of stick-slip and the sliding mode: one record per measured curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from tribolab.report.document import labels
from tribolab.report.tables import frame, labelled
from tribolab.report.wording import plain_value

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.outcome import CurveOutcome, ModelOutcome, Outcome
    from tribolab.mode.model import Mode
    from tribolab.mode.verdict import SlidingMode
    from tribolab.report.surface_records import SurfaceRows

_FIRST = [
    "sliding_speed",
    "direction",
    "waveform",
    "regularity",
    "oscillating_time_share",
    "dominant_frequency",
    "dominant_wavelength",
    "recurrence_distance",
    "drop",
    "events",
]
_ROUGH_ENOUGH = 0.0  # J/m2: a surface without macroscopic adhesion slides steadily
_CURVE = (
    "friction_coefficient",
    "friction_coefficient_model",
    "regime",
    "model_regime",
    "waveform",
    "regularity",
    "drop",
    "dominant_wavelength",
    "recurrence_distance",
    "dominant_frequency",
)


@dataclass(frozen=True)
class CurveSlip:
    """A measured curve with the stick-slip of its runs."""

    outcome: CurveOutcome
    measured: xr.Dataset
    slips: dict[str, xr.Dataset]
    model: xr.Dataset | None
    shear_stress: float | None
    curve: xr.Dataset
    band: xr.Dataset | None = None


def read_slip(outcome: Outcome, curve: CurveOutcome) -> CurveSlip:
    """Read a curve, the stick-slip of its runs and the model beside it.

    Raises
    ------
    TribolabError
        If a data file cannot be read.
    """
    from tribolab.friction.oscillation.slip_curve import stick_slip_curve
    from tribolab.io.netcdf import read_groups, read_netcdf

    folder = Path(outcome.folder)
    files = {run.name: run.data_file for run in outcome.runs if run.done}
    slips = {
        name: read_netcdf(folder / files[name], group="stick_slip")
        for name in curve.run_names
        if name in files
    }
    model, stress, band = None, None, None
    for one in outcome.models:
        if one.curve == curve.name and one.done and "fit" in one.parts:
            model, fit = read_groups(folder / one.data_file, ("curve", "fit")).values()
            found = float(fit.attrs["corrected_shear_stress_Pa"])
            stress = found if found > 0 else None
            if "uncertainty" in one.parts:
                band = read_netcdf(folder / one.data_file, group="uncertainty")
    measured = read_netcdf(folder / curve.data_file)
    over_speed = stick_slip_curve(list(slips.values()))
    return CurveSlip(curve, measured, slips, model, stress, over_speed, band)


def stick_slip_table(slip: xr.Dataset) -> pd.DataFrame:
    """Return a run's stick-slip as a table, a row per segment, numbered from 1."""
    table = frame(slip, "segment", _FIRST).drop(columns="segment", errors="ignore")
    probability = slip["class_probability"].max("waveform_class").values
    table.insert(3, "class_probability", probability)
    table.insert(0, "segment", np.arange(1, slip.sizes["segment"] + 1))
    return table


def sliding_tables(found: Sequence[CurveSlip], outcome: Outcome) -> list[pd.DataFrame]:
    """Return the rows of ``stick_slip.csv``, a table per run that belongs to a curve."""
    runs = {run.name: run for run in outcome.runs}
    return [
        labelled(stick_slip_table(slip), "run", name, labels(runs[name]))
        for one in found
        for name, slip in one.slips.items()
    ]


def judge_modes(
    found: Sequence[CurveSlip], outcome: Outcome, rows: Mapping[str, SurfaceRows]
) -> dict[str, SlidingMode]:
    """Weigh the sliding mode of every curve, by its name."""
    from tribolab.mode.verdict import sliding_mode

    known = {one.outcome.name: _known(one, outcome, rows) for one in found}
    stresses = {one.outcome.name: _stress(one, known[one.outcome.name]) for one in found}
    modes = {}
    for one in found:
        curve, mine = one.outcome, known[one.outcome.name]
        others = [
            stresses[other.outcome.name]
            for other in found
            if other.outcome.medium == curve.medium
            and other.outcome.surface != curve.surface
            and other.outcome.normal_force == curve.normal_force
            and known[other.outcome.name].work_of_adhesion == _ROUGH_ENOUGH
            and stresses[other.outcome.name]
        ]
        if mine.work_of_adhesion and others:
            mine = replace(mine, rough_shear_stress=min(others))
        modes[curve.name] = sliding_mode(
            one.measured, one.model, one.curve, mine, band=one.band, name=condition(curve)
        )
    return modes


def condition(curve: CurveOutcome | ModelOutcome) -> str:
    """Name a curve or its model by its surface, medium and load.

    A curve whose runs name none of them is called by its own name.
    """
    words = curve.surface
    if curve.medium:
        words += f" {curve.medium}" if curve.medium == "dry" else f" in {curve.medium}"
    if not words.strip():
        return curve.name
    if curve.normal_force is not None:
        words += f" at {curve.normal_force:g} N"
    return words.strip()


def _known(one: CurveSlip, outcome: Outcome, rows: Mapping[str, SurfaceRows]) -> Mode:
    from tribolab.mode.model import Mode

    curve = one.outcome
    medium = outcome.campaign.medium.get(curve.medium)
    fluid = curve.medium != "dry" if medium is None else medium.viscosity is not None
    modulus = outcome.campaign.contact.youngs_modulus
    mode = Mode(youngs_modulus=modulus, fluid=fluid)
    mine = rows.get(curve.surface)
    adhesion = [row for row in mine.adhesion if row["medium"] == curve.medium] if mine else []
    if not adhesion:
        return mode
    loads = [abs((row["normal_force_N"] or 0) - (curve.normal_force or 0)) for row in adhesion]
    row = adhesion[int(np.argmin(loads))]
    bounds = [row.get(f"macroscopic_work_of_adhesion_{end}_J_m2") for end in ("low", "high")]
    return replace(
        mode,
        work_of_adhesion=row["macroscopic_work_of_adhesion_J_m2"],
        work_of_adhesion_range=tuple(bounds) if None not in bounds else None,
        area_ratio=row["contact_area_ratio"],
        pressure=row["pressure_Pa"],
    )


def _stress(one: CurveSlip, known: Mode) -> float | None:
    """Shear stress in the real contact area with adhesion: fitted, else from mu p = sigma A/A0."""
    if one.shear_stress is not None:
        return one.shear_stress
    mu = one.measured["friction_coefficient"].values
    if not mu.size or known.fluid or not known.area_ratio or not known.pressure:
        return None
    return float(np.median(mu)) * known.pressure / known.area_ratio


def mode_record(one: CurveSlip, mode: SlidingMode) -> dict[str, Any]:
    """Return the sliding mode of a curve for report.json."""
    curve = mode.curve
    speeds = [
        {"sliding_speed_m_s": float(v)}
        | {name + _ENDING.get(name, ""): curve[name].values[k] for name in _CURVE if name in curve}
        for k, v in enumerate(curve["sliding_speed"].values)
    ]
    slow = one.curve
    return plain_value(
        {
            "curve": one.outcome.name,
            "condition": condition(one.outcome),
            **labels(one.outcome),
            "verdict": mode.verdict,
            "text": mode.text,
            "paragraph": mode.paragraph,
            "evidence": [piece._asdict() for piece in mode.evidence],
            "decide": list(mode.decide),
            "numbers": mode.numbers,
            "segments": int(slow["segments"].sum()) if "segments" in slow else 0,
            "segments_oscillating": int(slow["segments_oscillating"].sum())
            if "segments_oscillating" in slow
            else 0,
            "scaling": slow.attrs["scaling"],
            "scaling_exponent": slow.attrs["scaling_exponent"],
            "scaling_error": slow.attrs["scaling_error"],
            "speeds": speeds,
        }
    )


_ENDING = {"dominant_wavelength": "_m", "recurrence_distance": "_m", "dominant_frequency": "_Hz"}
