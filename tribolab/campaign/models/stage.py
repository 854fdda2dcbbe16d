"""Stage of the models: one for each measured curve in a fluid."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.models.kept import kept_model
from tribolab.campaign.models.plan import PlannedModel, plan_models
from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.catalogue import fingerprint_of
from tribolab.campaign.store.data_files import optional_data, write_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.errors import OutputError
from tribolab.core.provenance import made
from tribolab.core.untyped import Json
from tribolab.core.wording import explain
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.records.parts import Finding, ModelOutcome

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.settings.config import Campaign


@dataclass(frozen=True)
class ModelTask:
    """A model to compute, and the folder of the results."""

    model: PlannedModel
    folder: Path

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.model.name

    @property
    def fingerprint(self) -> str:
        """Checksum of data, settings and version."""
        return fingerprint_of(self.model.config_sha256)


class Models(Recorded[ModelTask, ModelRecord, ModelRecord]):
    """Stage that computes a model for each measured curve in a fluid.

    Parameters
    ----------
    campaign
        Campaign with media and contacts.
    curves, surfaces
        Their records.
    store
        Known results, and storage of new ones.
    """

    name = "models"
    kind = "model"
    record = ModelRecord

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        surfaces: Sequence[SurfaceRecord],
        store: Store,
    ) -> None:
        planned = plan_models(campaign, curves, surfaces)
        super().__init__(store, [ModelTask(model, store.folder) for model in planned])

    def taken(self, task: ModelTask, record: ModelRecord) -> ModelRecord | None:
        """Reuse a computed model, unless it now lacks inputs."""
        file = task.model.data_file
        if task.model.missing or not record.done or not self.linked(task, file, file):
            return None
        return replace(record, outcome=replace(record.outcome, reused=True))

    def order(self, tasks: Sequence[tuple[int, ModelTask]]) -> list[tuple[int, ModelTask]]:
        """Return the tasks with the slowest models first."""
        return sorted(tasks, key=lambda pair: not pair[1].model.uncertain)

    @staticmethod
    def work(task: ModelTask) -> ModelRecord:
        """Compute one model."""
        return process_model(task)

    def failed(self, task: ModelTask, error: BaseException) -> ModelRecord:
        """Return the record of a model whose worker died."""
        return ModelRecord(failed_model(task.model, *explain(error)))

    def keep(self, task: ModelTask, place: int, record: ModelRecord) -> ModelRecord:
        """Store the record of a model, or the earlier one if it cannot be computed now."""
        return super().keep(task, place, kept_model(self._store, record))


def process_model(task: ModelTask) -> ModelRecord:
    """Compute the curve, fit the shear stress, vary uncertain inputs; write and record them.

    Errors of the model are recorded.

    Raises
    ------
    OutputError
        If the results cannot be written.
    """
    # imported late for a quick start
    from tribolab.campaign.models.analysis import analyse_model
    from tribolab.records.models.model_rows import model_rows

    began = time.monotonic()
    model = task.model
    if model.missing:
        return ModelRecord(failed_model(model, model.missing, status="skipped"))
    curve = model.curve
    try:
        groups, findings = analyse_model(model, task.folder)
        write_data({None: _root(model)} | groups, task.folder / model.data_file)
        adhesion = optional_data(task.folder / model.surface_file, "adhesion_loads")
        rows = model_rows(groups, curve.medium, model.normal_force, adhesion)
    except OutputError:
        raise
    except Exception as error:  # recorded: one failed model must not stop the others
        reason, name = explain(error)
        return ModelRecord(failed_model(model, reason, name, time.monotonic() - began))
    outcome = ModelOutcome(
        name=model.name,
        curve=curve.name,
        surface=curve.surface,
        medium=curve.medium,
        normal_force=curve.normal_force,
        status="done",
        data_file=model.data_file,
        parts=tuple(groups),
        findings=tuple(findings),
        seconds=time.monotonic() - began,
    )
    return ModelRecord(outcome, rows)


def failed_model(
    model: PlannedModel, reason: str, error: str = "", seconds: float = 0.0, status: str = "failed"
) -> ModelOutcome:
    """Return the outcome of a model that has no results."""
    severity = "note" if status == "skipped" else "fail"
    curve = model.curve
    return ModelOutcome(
        name=model.name,
        curve=curve.name,
        surface=curve.surface,
        medium=curve.medium,
        normal_force=curve.normal_force,
        status=status,
        reason=reason,
        error=error,
        seconds=seconds,
        findings=(Finding(severity, f"no model: {reason}"),),
    )


def _root(model: PlannedModel) -> xr.Dataset:
    # imported late: xarray loads slowly
    import xarray as xr

    curve = model.curve
    attrs: Json = {
        "surface": curve.surface,
        "medium": curve.medium,
        "normal_force_N": float(model.normal_force),
        "curve": curve.name,
        "repeatability": model.repeatability,
        "freedom": model.freedom,
    }
    origin = made(
        f"model of {curve.name}",
        source=model.source,
        source_sha256=model.source_sha256,
        config_sha256=model.config_sha256,
    )
    return xr.Dataset(attrs=attrs | origin)
