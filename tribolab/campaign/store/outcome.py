"""What a campaign came to, in all its parts."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.store.catalogue import Catalogue, Store
    from tribolab.records.parts import (
        CurveOutcome,
        ModelOutcome,
        PartOutcome,
        RunOutcome,
        Source,
        SurfaceOutcome,
    )


@dataclass(frozen=True)
class Outcome:
    """Everything that a campaign came to.

    Parameters
    ----------
    campaign
        The campaign as it was read.
    folder
        Where the results lie (while they are being written: the staging folder).
    store
        The catalogue of all that is recorded, for reading.
    runs, curves
        One record each, in the order of the campaign file.
    sources
        (path relative to the campaign file, sha256, bytes) of every file that was read; a file
        that could not be read has the sha256 "".
    surfaces
        One record for each surface of the campaign file.
    models
        One record for each measured curve with a fluid, in the order of the curves.
    foreign
        Files in the results folder that are not ours; they were left there.
    lost_decisions
        Which decisions in the review file are on a run that there is not.
    damaged
        Files of the earlier results that were not as they had been written.
    """

    campaign: Campaign
    folder: Path
    store: Catalogue
    runs: tuple[RunOutcome, ...]
    curves: tuple[CurveOutcome, ...]
    sources: tuple[Source, ...]
    surfaces: tuple[SurfaceOutcome, ...] = ()
    models: tuple[ModelOutcome, ...] = ()
    foreign: tuple[str, ...] = ()
    lost_decisions: tuple[str, ...] = ()
    damaged: tuple[str, ...] = ()

    @property
    def kept(self) -> dict[str, str]:
        """Names of the parts that are earlier results, and why."""
        parts: tuple[PartOutcome, ...] = (*self.runs, *self.surfaces, *self.models)
        return {part.name: part.kept for part in parts if part.kept}

    @property
    def failed(self) -> tuple[RunOutcome, ...]:
        """The runs that have no results."""
        return tuple(run for run in self.runs if not run.done)

    @property
    def failed_models(self) -> tuple[ModelOutcome, ...]:
        """The models that should be there and are not; of one skipped too little is known."""
        return tuple(model for model in self.models if model.status == "failed")

    @property
    def segments(self) -> int:
        """Number of segments found in all runs."""
        return sum(run.segments for run in self.runs)


@dataclass(frozen=True)
class OpenOutcome(Outcome):
    """What a campaign came to while it is being written: its store takes more."""

    store: Store

    def read_at(
        self,
        folder: Path,
        store: Catalogue,
        foreign: tuple[str, ...],
        damaged: tuple[str, ...] = (),
    ) -> Outcome:
        """Return what it came to, as it now lies in a folder for reading."""
        parts = {part.name: getattr(self, part.name) for part in fields(self)}
        now = {"folder": folder, "store": store, "foreign": foreign, "damaged": damaged}
        return Outcome(**parts | now)
