"""The work on one surface, as a worker process does it."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.campaign.outcome import Finding, SurfaceOutcome
from tribolab.campaign.surface_plan import PlannedSurface
from tribolab.campaign.work import Source, explain, source_of, write_data
from tribolab.errors import OutputError
from tribolab.provenance import made

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.surface_scans import CheckedScans

RECORD = "surface_record"
SCANS = "scans"  # group of the scans as they were read, with their quality flags


@dataclass(frozen=True)
class SurfaceTask:
    """A surface to process, and the folder of the results."""

    surface: PlannedSurface
    folder: Path


@dataclass(frozen=True)
class SurfaceRecord:
    """What a worker hands back: the outcome and the files that were read."""

    outcome: SurfaceOutcome
    sources: tuple[Source, ...]


def process_surface(task: SurfaceTask) -> SurfaceRecord:
    """Compute spectrum, roughness, contact, adhesion and rubber friction; write the data file.

    What goes wrong with the surface is in the record.

    Raises
    ------
    OutputError
        If the results cannot be written: that is no fault of the surface.
    """
    began = time.monotonic()
    surface = task.surface
    if not surface.files:
        text = "no scans are named, so its roughness and contact are not computed"
        return SurfaceRecord(
            SurfaceOutcome(surface.name, (), "skipped", findings=(Finding("note", text),)), ()
        )
    from tribolab.campaign.surface_scans import usable_scans

    sources = sources_of(surface)
    checked: CheckedScans | None = None
    try:
        checked = usable_scans(surface)
        groups, findings = analyse(surface, checked)
        outcome = SurfaceOutcome(
            name=surface.name,
            files=surface.labels,
            status="done",
            data_file=surface.data_file,
            seconds=time.monotonic() - began,
            parts=tuple(groups),
            findings=tuple(findings),
            quality=checked.quality,
            checks=tuple(checked.checks),
        )
        write_data({None: _root(surface, sources, outcome)} | groups, _place(task))
    except OutputError:
        raise
    except Exception as error:  # recorded: one bad surface must not stop the others
        outcome = failed_surface(surface, *explain(error), time.monotonic() - began)
        if checked is not None:  # what the checks said may be why
            findings = (*outcome.findings, *checked.findings)
            outcome = replace(outcome, findings=findings, checks=tuple(checked.checks))
    return SurfaceRecord(outcome, sources)


def analyse(
    surface: PlannedSurface, checked: CheckedScans
) -> tuple[dict[str, xr.Dataset], list[Finding]]:
    """Return the groups of a surface's data file, and the findings.

    Raises
    ------
    TribolabError
        If the scans have no spectrum.
    """
    from tribolab.campaign.surface_contact import contact_groups, lowest_wavenumber
    from tribolab.campaign.surface_scans import spectra

    findings = list(checked.findings)
    q_low = lowest_wavenumber(surface)
    if q_low is None and "q_low" not in surface.roughness:
        text = "the spectrum begins where the scans do: no load and contact tell the width of both"
        findings.append(Finding("note", text))
    groups, more = spectra(surface, checked.scans, q_low)
    findings += more
    contact, more = contact_groups(surface, groups["psd"])
    return {SCANS: checked.raw} | groups | contact, findings + more


def failed_surface(
    surface: PlannedSurface, reason: str, error: str, seconds: float = 0.0
) -> SurfaceOutcome:
    """Return the outcome of a surface that has no results."""
    return SurfaceOutcome(
        name=surface.name,
        files=surface.labels,
        status="failed",
        reason=reason,
        error=error,
        seconds=seconds,
        findings=(Finding("fail", reason),),
    )


def sources_of(surface: PlannedSurface) -> tuple[Source, ...]:
    """Return label, checksum and size of the scans and of the modulus file."""
    files = list(zip(surface.files, surface.labels, strict=True))
    if surface.modulus_file is not None:
        files.append(surface.modulus_file)
    return tuple(source_of(file, label) for file, label in files)


def named(sources: Sequence[Source]) -> dict[str, str]:
    """Return ``source`` and ``source_sha256`` of files."""
    return {
        "source": "; ".join(label for label, _, _ in sources),
        "source_sha256": "; ".join(checksum for _, checksum, _ in sources),
    }


def known_surface(
    path: Path, surface: PlannedSurface
) -> tuple[tuple[Source, ...], SurfaceOutcome] | None:
    """Return sources and outcome of earlier results, if settings and version are the same."""
    from tribolab import __version__

    found = _stored(path)
    if found is None:
        return None
    attrs, sources, stored = found
    same = (attrs.get("config_sha256"), attrs.get("tribolab_version"))
    if same != (surface.config_sha256, __version__):
        return None
    facts = {"name": surface.name, "files": surface.labels, "data_file": surface.data_file}
    return sources, replace(stored, **facts, reused=True)


def earlier_surface(
    path: Path, now: SurfaceOutcome
) -> tuple[tuple[Source, ...], SurfaceOutcome] | None:
    """Return sources and outcome of earlier results, whatever the settings were."""
    found = _stored(path)
    if found is None:
        return None
    _, sources, stored = found
    return sources, replace(stored, name=now.name)


def _stored(path: Path) -> tuple[dict[str, Any], tuple[Source, ...], SurfaceOutcome] | None:
    """Return attributes, sources and outcome that a data file holds; None if it is damaged."""
    from tribolab.io.netcdf import opened

    if not path.is_file():
        return None
    try:
        with opened(path) as file:
            attrs, groups = file.__dict__, tuple(file.groups)
        record: dict[str, Any] = json.loads(attrs[RECORD])
        sources = tuple((str(n), str(c), int(b)) for n, c, b in record["sources"])
        if groups != tuple(record["parts"]):
            return None
        outcome = SurfaceOutcome(
            name=str(attrs.get("surface", "")),
            files=tuple(label for label, _, _ in sources),
            status="done",
            data_file=f"data/{path.name}",
            parts=groups,
            findings=tuple(Finding(*finding) for finding in record["findings"]),
            quality=str(record["quality"]),
            checks=tuple(map(dict, record["checks"])),
        )
    except (OSError, RuntimeError, LookupError, ValueError, TypeError):  # damaged: done anew
        return None
    return attrs, sources, outcome


def _place(task: SurfaceTask) -> Path:
    return task.folder / task.surface.data_file


def _root(
    surface: PlannedSurface, sources: tuple[Source, ...], outcome: SurfaceOutcome
) -> xr.Dataset:
    """Attributes of the whole file; checksums also of what could not be used."""
    import xarray as xr

    record = {
        "sources": sources,
        "findings": outcome.findings,
        "parts": outcome.parts,
        "quality": outcome.quality,
        "checks": outcome.checks,
    }
    return xr.Dataset(
        attrs={
            "surface": surface.name,
            "quality": outcome.quality,
            RECORD: json.dumps(record, ensure_ascii=False),
        }
        | made(
            f"spectrum and contact of {surface.name}",
            **named(sources),
            config_sha256=surface.config_sha256,
        )
    )
