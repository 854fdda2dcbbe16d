"""All loads of a surface in one liquid in one fit, and surfaces that are stated to be together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tribolab.campaign.joint.plan import JointParts, JointTask
from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.catalogue import Store
from tribolab.records.joint_record import JointRecord
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.words import explain

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign


class JointFits(Recorded[JointTask, JointRecord, JointRecord]):
    """The stage of the joint fits.

    Parameters
    ----------
    campaign
        It knows the liquids and the contact.
    curves, models, surfaces
        What is recorded of them.
    store
        What is known, and where it is written down.
    """

    name = "joint fits"
    kind = "joint"
    record = JointRecord

    def __init__(
        self,
        campaign: Campaign,
        curves: Sequence[CurveRecord],
        models: Sequence[ModelRecord],
        surfaces: Sequence[SurfaceRecord],
        store: Store,
    ) -> None:
        super().__init__(store)
        self._parts = JointParts(campaign, curves, models, surfaces, store)

    def plan(self) -> list[JointTask]:
        """Return a task for each surface and liquid, and for surfaces that belong together."""
        return self._parts.tasks()

    def linked(self, task: JointTask, record: JointRecord) -> bool:
        """Have the data file among the new ones."""
        return self._store.link(self.kind, task.name, record.file, record.file)

    @staticmethod
    def work(task: JointTask) -> JointRecord:
        """Fit what belongs together in one liquid."""
        from tribolab.campaign.joint.work import fitted

        return fitted(task)

    def failed(self, task: JointTask, error: BaseException) -> JointRecord:
        """Return the record of a fit that failed: the single fits stand without it."""
        names = tuple(model.curve for model in task.models)
        reason = explain(error)[0]
        return JointRecord(task.name, task.surface, task.medium, names, "failed", reason)
