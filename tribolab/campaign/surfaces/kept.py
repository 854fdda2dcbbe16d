"""Earlier surfaces that are kept because their scans or modulus cannot be read."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from tribolab.campaign.settings.naming.named import is_named
from tribolab.campaign.store.kept import GONE, VERDICTS, kept_record
from tribolab.records.part_records import SurfaceRecord
from tribolab.records.parts import Finding

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.store.new_catalogue import Store
    from tribolab.campaign.surfaces.plan import PlannedSurface


def kept_surface(
    campaign: Campaign, planned: PlannedSurface, store: Store, record: SurfaceRecord
) -> SurfaceRecord:
    """Return the earlier record of a surface if its scans or modulus file cannot be read now.

    These files are its scans and its modulus. The outcome states that it is kept. Without such
    files, or without earlier results, the record is returned unchanged.
    """
    now = record.outcome
    known = store.before.get("surface", now.name, SurfaceRecord)
    if known is None or now.status == "skipped":
        return record
    before, sources = known.record.outcome, known.record.sources
    if not before.done:
        return record
    names = [label for label, _, _ in sources]
    content = {checksum for _, checksum, _ in record.sources}
    spoilt = _unreadable_files(now.findings, names) - _unreadable_files(before.findings, names)
    gone = {
        label
        for label, checksum, _ in sources
        if label not in {mine for mine, _, _ in record.sources}
        and checksum not in content
        and is_named(campaign, planned.patterns, label)
    }
    why = sorted(f"{PurePosixPath(label).name}: {GONE}" for label in gone)
    why += sorted(f"{PurePosixPath(label).name} cannot be read" for label in spoilt)
    what = "scans"
    if planned.modulus_file is not None and planned.modulus_file[1] in names:
        lost = {"modulus"} & {*before.parts} - {*now.parts}
        if lost and any(f.severity in ("fail", "error") for f in now.findings if not f.check):
            what = "scans" if why else "its modulus"
            why.append(f"{planned.modulus_file[0].name} cannot be read")
    if not now.done and now.error not in VERDICTS:
        why.append(now.reason)
    if not why:
        return record
    text = f"{what} cannot be read now ({why[0]})"
    return kept_record(store, "surface", known.record, text, planned.data_file) or record


def _unreadable_files(findings: Iterable[Finding], labels: Iterable[str]) -> set[str]:
    """Return the files that could not be read, from the findings."""
    grave = [f.message for f in findings if f.severity == "fail" and not f.check]
    return {label for label in labels for text in grave if f"scan {label} is left out" in text}
