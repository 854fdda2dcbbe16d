"""Stage of the surfaces: spectrum, roughness, contact and adhesion, one worker each."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.runs.sources import source_of
from tribolab.campaign.store.catalogue import fingerprint_of
from tribolab.campaign.store.data_files import digest, write_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.surfaces.kept import kept_surface
from tribolab.campaign.surfaces.plan import PlannedSurface, plan_surfaces
from tribolab.core.errors import OutputError
from tribolab.core.provenance import made, source_attributes
from tribolab.core.wording import explain
from tribolab.records.part_records import SurfaceRecord
from tribolab.records.parts import Finding, RunOutcome, Source, SurfaceOutcome
from tribolab.records.wording import plain_value

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.surfaces.scans import CheckedScans

_SCANS = "scans"  # group of the scans as read, with their quality flags


@dataclass(frozen=True)
class SurfaceTask:
    """Surface to process, and the folder of the results."""

    surface: PlannedSurface
    folder: Path

    @property
    def name(self) -> str:
        """Name of the surface."""
        return self.surface.name

    @property
    def fingerprint(self) -> str:
        """Checksum of settings and version; scans are compared separately."""
        return fingerprint_of(self.surface.config_sha256)


class Surfaces(Recorded[SurfaceTask, SurfaceRecord, SurfaceRecord]):
    """Stage that computes spectrum, roughness and contact of each surface.

    Parameters
    ----------
    campaign
        Campaign with the scans.
    runs
        Outcomes of the runs, for the loads.
    store
        Known results, and storage of new ones.
    """

    name = "surfaces"
    kind = "surface"
    record = SurfaceRecord

    def __init__(self, campaign: Campaign, runs: Iterable[RunOutcome], store: Store) -> None:
        super().__init__(store)
        self._campaign, self._runs = campaign, runs
        self._began = time.time_ns()

    def plan(self) -> list[SurfaceTask]:
        """Return a task for each surface of the campaign file."""
        planned = plan_surfaces(self._campaign, self._runs)
        return [SurfaceTask(surface, self._store.folder) for surface in planned]

    def taken(self, task: SurfaceTask, record: SurfaceRecord) -> SurfaceRecord | None:
        """Reuse a surface whose files have the same checksums."""
        surface, before = task.surface, record.outcome
        same = record.done and self._store.sources(_files(surface)) == record.sources
        if not same or not self.linked(task, before.data_file, surface.data_file):
            return None
        outcome = replace(before, files=surface.labels, data_file=surface.data_file, reused=True)
        return replace(record, outcome=outcome)

    @staticmethod
    def work(task: SurfaceTask) -> SurfaceRecord:
        """Process one surface."""
        return process_surface(task)

    def failed(self, task: SurfaceTask, error: BaseException) -> SurfaceRecord:
        """Return the record of a surface whose worker died."""
        return SurfaceRecord(failed_surface(task.surface, *explain(error)))

    def keep(self, task: SurfaceTask, place: int, record: SurfaceRecord) -> SurfaceRecord:
        """Store the record of a surface, or the earlier one if its scans cannot be read now."""
        record = kept_surface(self._campaign, task.surface, self._store, record)
        super().keep(task, place, record)
        files = [path for path, _ in _files(task.surface)]
        self._store.note_sources(zip(files, record.sources, strict=False), self._began)
        return record


def process_surface(task: SurfaceTask) -> SurfaceRecord:
    """Compute all results of a surface, write and record them.

    Errors of the surface are recorded.

    Raises
    ------
    OutputError
        If the results cannot be written.
    """
    # imported late for a quick start
    from tribolab.records.surfaces.surface_rows import surface_rows

    began = time.monotonic()
    surface = task.surface
    if not surface.files:
        text = "no scans are named, so its roughness and contact are not computed"
        note = Finding("note", text)
        return SurfaceRecord(
            SurfaceOutcome(name=surface.name, files=(), status="skipped", findings=(note,))
        )
    from tribolab.campaign.surfaces.scans import usable_scans  # imported late for a quick start

    sources = sources_of_surface(surface)
    checked: CheckedScans | None = None
    try:
        checked = usable_scans(surface)
        groups, findings = analyse_surface(surface, checked)
        outcome = SurfaceOutcome(
            name=surface.name,
            files=surface.labels,
            status="done",
            data_file=surface.data_file,
            seconds=time.monotonic() - began,
            parts=tuple(groups),
            findings=tuple(findings),
            quality=checked.quality,
            checks=tuple(plain_value(checked.checks)),
        )
        root = _root(surface, sources, checked.quality)
        write_data({None: root} | groups, task.folder / surface.data_file)
        shown = {name: data for name, data in groups.items() if name != _SCANS}
        rows = surface_rows(surface.name, shown, checked.quality)
        shaping = digest(groups.get("psd"), groups.get("adhesion_loads"))
    except OutputError:
        raise
    except Exception as error:  # recorded: one bad surface must not stop the others
        outcome = failed_surface(surface, *explain(error), time.monotonic() - began)
        if checked is not None:  # results of the checks may explain it
            merged = (*outcome.findings, *checked.findings)
            outcome = replace(outcome, findings=merged, checks=tuple(plain_value(checked.checks)))
        return SurfaceRecord(outcome, sources)
    return SurfaceRecord(outcome, sources, rows, shaping)


def analyse_surface(
    surface: PlannedSurface, checked: CheckedScans
) -> tuple[dict[str, xr.Dataset], list[Finding]]:
    """Compute the groups of a surface's data file, and the findings.

    Raises
    ------
    TribolabError
        If the scans have no spectrum.
    """
    # imported late for a quick start
    from tribolab.campaign.surfaces.contact import contact_groups, lowest_wavenumber
    from tribolab.campaign.surfaces.scans import spectra_of_scans

    findings = list(checked.findings)
    q_low = lowest_wavenumber(surface)
    if q_low is None and "q_low" not in surface.roughness:
        text = "the spectrum begins where the scans do: no load and contact tell the width of both"
        findings.append(Finding("note", text))
    groups, more = spectra_of_scans(surface, checked.scans, q_low)
    findings += more
    if "psd" not in groups:
        return {_SCANS: checked.raw} | groups, findings
    contact, more = contact_groups(surface, groups["psd"])
    return {_SCANS: checked.raw} | groups | contact, findings + more


def failed_surface(
    surface: PlannedSurface, reason: str, error: str, seconds: float = 0.0
) -> SurfaceOutcome:
    """Return the outcome of a surface without results."""
    return SurfaceOutcome(
        name=surface.name,
        files=surface.labels,
        status="failed",
        reason=reason,
        error=error,
        seconds=seconds,
        findings=(Finding("fail", reason),),
    )


def _files(surface: PlannedSurface) -> list[tuple[Path, str]]:
    """Return the scans and modulus file, with their labels."""
    files = list(zip(surface.files, surface.labels, strict=True))
    return files if surface.modulus_file is None else [*files, surface.modulus_file]


def sources_of_surface(surface: PlannedSurface) -> tuple[Source, ...]:
    """Return label, checksum and size of the scans and of the modulus file."""
    return tuple(source_of(path, label) for path, label in _files(surface))


def _root(surface: PlannedSurface, sources: tuple[Source, ...], quality: str) -> xr.Dataset:
    """Return the attributes of the whole file, with checksums also of unused files."""
    # imported late: xarray loads slowly
    import xarray as xr

    what = f"spectrum and contact of {surface.name}"
    origin = made(what, **source_attributes(sources), config_sha256=surface.config_sha256)
    return xr.Dataset(attrs={"surface": surface.name, "quality": quality} | origin)
