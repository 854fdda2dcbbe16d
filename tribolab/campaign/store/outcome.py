"""Outcome of a campaign with all its parts."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.html_list import html_list
from tribolab.core.wording import many

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.store.catalogue import Catalogue
    from tribolab.campaign.store.new_catalogue import Store
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
    """Outcome of a campaign.

    Parameters
    ----------
    campaign
        The campaign that was processed.
    folder
        Folder of the results (the staging folder while they are written).
    store
        Catalogue of all records, for reading.
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
        Files in the results folder that tribolab did not write; they are kept.
    lost_decisions
        Decisions in the review file on runs that do not exist.
    damaged
        Files of the earlier results that were changed.
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
        """Reasons why parts are kept from earlier results, by name."""
        parts: tuple[PartOutcome, ...] = (*self.runs, *self.surfaces, *self.models)
        return {part.name: part.kept for part in parts if part.kept}

    @property
    def failed(self) -> tuple[RunOutcome, ...]:
        """Runs without results."""
        return tuple(run for run in self.runs if not run.done)

    @property
    def failed_models(self) -> tuple[ModelOutcome, ...]:
        """Models that failed; skipped ones, whose inputs are incomplete, are not included."""
        return tuple(model for model in self.models if model.status == "failed")

    @property
    def segments(self) -> int:
        """Number of segments found in all runs."""
        return sum(run.segments for run in self.runs)

    def _repr_html_(self) -> str:
        """Return the numbers of runs, surfaces and models, and what failed, as HTML."""
        failed = [(run.name, run.reason) for run in self.failed]
        failed += [(model.name, model.reason) for model in self.failed_models]
        counts = f"{many(len(self.runs), 'run')}, {many(self.segments, 'segment')}"
        return html_list(f"{self.folder}: {counts}", [("failed: " + n, why) for n, why in failed])


@dataclass(frozen=True)
class OpenOutcome(Outcome):
    """Outcome of a campaign while it is written; its store accepts more records."""

    store: Store

    def read_at(
        self,
        folder: Path,
        store: Catalogue,
        foreign: tuple[str, ...],
        damaged: tuple[str, ...] = (),
    ) -> Outcome:
        """Return the outcome of the published results in a folder, for reading."""
        parts = {part.name: getattr(self, part.name) for part in fields(self)}
        now = {"folder": folder, "store": store, "foreign": foreign, "damaged": damaged}
        return Outcome(**parts | now)
