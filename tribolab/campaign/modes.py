"""Sliding mode of each measured contact, judged from its curve, model and traces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.campaign.curves import SLIP
from tribolab.campaign.recorded import Recorded
from tribolab.campaign.settings.contact_pairs import contact_of_label
from tribolab.campaign.store.data_files import optional_data, read_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import explain
from tribolab.records.models.mode_record import EvidenceRow, ModeRecord, condition
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import CurveOutcome, Notice, Row, number_of
from tribolab.records.wording import plain_value
from tribolab.regime.model import Mode

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign

_ROUGH_ENOUGH = 0.0  # J/m2: work of adhesion of surfaces without macroscopic adhesion
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
_ENDING = {"dominant_wavelength": "_m", "recurrence_distance": "_m", "dominant_frequency": "_Hz"}
SPEED_COLUMNS = tuple(name + _ENDING.get(name, "") for name in _CURVE)  # columns available


@dataclass(frozen=True)
class ModeTask:
    """Measured curve to judge, the data file of its model (or ""), and known properties."""

    curve: CurveOutcome
    model_file: str
    with_band: bool
    known: Mode
    folder: Path
    fingerprint: str

    @property
    def name(self) -> str:
        """Name of the curve and of its verdict."""
        return self.curve.name


class Modes(Recorded[ModeTask, ModeRecord, Notice]):
    """Stage that judges the sliding mode of each measured curve.

    Parameters
    ----------
    campaign
        Campaign with media and contacts.
    curves, surfaces, models
        Their records.
    store
        Known results, and storage of new ones.
    """

    name = "modes"
    kind = "mode"
    record = ModeRecord

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        surfaces: Sequence[SurfaceRecord],
        models: Sequence[ModelRecord],
        store: Store,
    ) -> None:
        super().__init__(store)
        self._curves = [c for c in curves if c.outcome.done and _has_friction(c)]
        self._known = _known_by_curve(campaign, self._curves, surfaces, models)
        self._models = {m.outcome.curve: m for m in models if m.outcome.done}

    def plan(self) -> list[ModeTask]:
        """Return a task for each measured curve."""
        tasks = []
        for record in self._curves:
            curve = record.outcome
            model = self._models.get(curve.name)
            parts = model.outcome.parts if model else ()
            fitted = model is not None and "fit" in parts
            known = self._known[curve.name]
            files = [curve.data_file, *([model.outcome.data_file] if model and fitted else [])]
            shaping = [asdict(known), [self._store.identity(file) for file in files]]
            tasks.append(
                ModeTask(
                    curve=curve,
                    model_file=model.outcome.data_file if model and fitted else "",
                    with_band="uncertainty" in parts,
                    known=known,
                    folder=self._store.folder,
                    fingerprint=sha256_of(shaping),
                )
            )
        return tasks

    @staticmethod
    def work(task: ModeTask) -> ModeRecord:
        """Judge one curve."""
        return judge_mode(task)

    def failed(self, task: ModeTask, error: BaseException) -> Notice:
        """Return the reason why a curve could not be judged."""
        members = "; ".join(task.curve.run_names)
        return Notice("error", members, f"stick-slip {task.name}", explain(error)[0])


def judge_mode(task: ModeTask) -> ModeRecord:
    """Collect the evidence for and against an adhesion-controlled sliding mode.

    Raises
    ------
    TribolabError
        If a data file cannot be read.
    """
    # imported late for a quick start
    from tribolab.friction.oscillation.waveform import oscillating
    from tribolab.regime.verdict import sliding_mode

    curve = task.curve
    measured = read_data(task.folder / curve.data_file)
    slip = read_data(task.folder / curve.data_file, SLIP)
    model = band = None
    if task.model_file:
        model = read_data(task.folder / task.model_file, "curve")
        if task.with_band:
            band = optional_data(task.folder / task.model_file, "uncertainty")
    mode = sliding_mode(measured, model, slip, task.known, band=band, name=condition(curve))
    speeds = [
        {"sliding_speed_m_s": float(v)}
        | {
            column: mode.curve[name].values[k]
            for name, column in zip(_CURVE, SPEED_COLUMNS, strict=True)
            if name in mode.curve
        }
        for k, v in enumerate(mode.curve["sliding_speed"].values)
    ]
    counts = {
        name: int(slip[name].sum()) if name in slip else 0
        for name in ("segments", "segments_oscillating")
    }
    return ModeRecord(
        curve=curve.name,
        condition=condition(curve),
        verdict=mode.verdict,
        text=mode.text,
        paragraph=mode.paragraph,
        decide=tuple(mode.decide),
        evidence=tuple(EvidenceRow(*piece) for piece in mode.evidence),
        numbers=plain_value(mode.numbers),
        **counts,
        scaling=str(slip.attrs["scaling"]),
        scaling_exponent=plain_value(slip.attrs["scaling_exponent"]),
        scaling_error=plain_value(slip.attrs["scaling_error"]),
        speeds=tuple(plain_value(speeds)),
        moves="waveform" in slip and bool(oscillating(slip["waveform"].values).any()),
    )


def _has_friction(curve: CurveRecord) -> bool:
    return any(row["friction_coefficient"] is not None for row in curve.points)


def _known_by_curve(
    campaign: Campaign,
    curves: Sequence[CurveRecord],
    surfaces: Iterable[SurfaceRecord],
    models: Iterable[ModelRecord],
) -> dict[str, Mode]:
    """Return the known properties of each curve, with the shear stress of rough surfaces."""
    rows = {surface.outcome.name: surface for surface in surfaces}
    fits = {m.outcome.curve: m.rows.fit for m in models if m.rows is not None and m.rows.fit}
    known = {c.outcome.name: _known(campaign, c, rows.get(c.outcome.surface)) for c in curves}
    stresses = {
        c.outcome.name: _stress(c, fits.get(c.outcome.name), known[c.outcome.name]) for c in curves
    }
    for record in curves:
        curve, mine = record.outcome, known[record.outcome.name]
        others = [
            stress
            for other in curves
            if other.outcome.medium == curve.medium
            and other.outcome.surface != curve.surface
            and other.outcome.normal_force == curve.normal_force
            and known[other.outcome.name].work_of_adhesion == _ROUGH_ENOUGH
            and (stress := stresses[other.outcome.name])
        ]
        if mine.work_of_adhesion and others:
            known[curve.name] = replace(mine, rough_shear_stress=min(others))
    return known


def _known(campaign: Campaign, record: CurveRecord, surface: SurfaceRecord | None) -> Mode:
    curve = record.outcome
    medium = campaign.medium.get(curve.medium)
    fluid = (
        curve.medium != "dry" if medium is None else campaign.viscosity_of(curve.medium) is not None
    )
    contact = contact_of_label(campaign, curve.surface)
    mode = Mode(youngs_modulus=contact.youngs_modulus, fluid=fluid)
    rows = surface.rows if surface else None
    adhesion = [row for row in rows.adhesion if row["medium"] == curve.medium] if rows else []
    if not adhesion:
        return mode
    wanted = curve.normal_force or 0.0
    loads = [abs(float(row["normal_force_N"] or 0) - wanted) for row in adhesion]
    row = adhesion[int(np.argmin(loads))]
    work, low, high = (
        number_of(row, f"macroscopic_work_of_adhesion{end}_J_m2") for end in ("", "_low", "_high")
    )
    return replace(
        mode,
        work_of_adhesion=work,
        work_of_adhesion_range=None if low is None or high is None else (low, high),
        area_ratio=number_of(row, "contact_area_ratio"),
        pressure=number_of(row, "pressure_Pa"),
    )


def _stress(record: CurveRecord, fit: Row | None, known: Mode) -> float | None:
    """Return the shear stress in the contact area with adhesion: fitted, or µ p / (A/A0) if dry."""
    fitted = None if fit is None else number_of(fit, "corrected_shear_stress_Pa")
    if fitted is not None and fitted > 0:
        return float(fitted)
    mu = [row["friction_coefficient"] for row in record.points]
    if not mu or known.fluid or not known.area_ratio or not known.pressure:
        return None
    return float(np.median(np.array(mu, float))) * known.pressure / known.area_ratio
