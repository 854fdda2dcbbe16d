"""Plan for each surface: its scans, and properties from the campaign file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.settings.contact_pairs import contact_pairs
from tribolab.campaign.settings.files import instrument_of, label_of, scans_of, sha256_of_dialect
from tribolab.campaign.settings.naming.run_names import distinct, safe_name
from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.core.untyped import Arguments

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.contact.area import AreaTheory
    from tribolab.records.parts import RunOutcome


@dataclass(frozen=True)
class PlannedMedium:
    """Medium with its work of adhesion [J/m2]; missing bounds are equal to it."""

    name: str
    work_of_adhesion: float
    low: float
    high: float


@dataclass(frozen=True)
class PlannedSurface:
    """Surface to be processed, with all that a worker needs.

    Parameters
    ----------
    name
        Name in the campaign file, with the name of the contact if it has one.
    data_file
        Path of its data file relative to the results folder.
    patterns, files, labels
        Scans as the campaign file names them, absolute, and relative to the campaign file.
    instrument
        Dialect of the scans, if the campaign file names one.
    roughness
        The table [roughness].
    contact
        The table of its contact; None if empty.
    forces
        Normal forces of the runs on this surface, and those of [contact] [N], increasing.
    lowest_force
        Lowest normal force of the whole campaign [N], if any is known.
    media
        Media whose work of adhesion is known.
    modulus_file
        File of the viscoelastic modulus, and its label; None without one.
    modulus_read
        Sweep to use, and the unit if the file does not state it.
    rubber
        The table [rubber].
    rubber_work
        Work of adhesion [J/m2] that adds to the contact of the sliding rubber; None for none.
    quality
        Arguments of `check_scan_set`: limits, skip.
    area
        Theory of the contact area.
    config_sha256
        Checksum of all of these except the scans.
    """

    name: str
    data_file: str
    patterns: tuple[str, ...]
    files: tuple[Path, ...]
    labels: tuple[str, ...]
    instrument: str | None
    roughness: Arguments
    contact: Arguments
    forces: tuple[float, ...]
    lowest_force: float | None
    media: tuple[PlannedMedium, ...]
    modulus_file: tuple[Path, str] | None = None
    modulus_read: tuple[int | str | None, str | None] = (None, None)
    rubber: Arguments = field(default_factory=dict)
    rubber_work: float | None = None
    area: AreaTheory = "persson"
    quality: Arguments = field(default_factory=dict)
    config_sha256: str = field(default="", compare=False)


def plan_surfaces(campaign: Campaign, runs: Iterable[RunOutcome]) -> tuple[PlannedSurface, ...]:
    """Collect the properties of each surface, in the order of the campaign file.

    Parameters
    ----------
    campaign
        From `load_campaign`.
    runs
        Outcomes of the runs, for the normal forces.
    """
    known = [
        (run.surface, float(f"{load:.4g}"))
        for run in runs
        for load in run.load_levels or (run.normal_force,)
        if load is not None and load > 0
    ]
    pairs = contact_pairs(campaign, [surface for surface, _ in known])
    stated = [float(f"{force:.4g}") for force in campaign.model.normal_forces]
    every = [force for _, force in known] + stated
    media = tuple(
        PlannedMedium(name, work, *(medium.work_of_adhesion_range or (work, work)))
        for name, medium in campaign.medium.items()
        # at or below zero the liquid separates the surfaces: there is no adhesion to compute
        if (work := medium.work_of_adhesion) is not None and work > 0
    )
    files = distinct(f"surface_{safe_name(pair.label)}" for pair in pairs)
    sticky = campaign.rubber.adhesion
    planned = []
    for pair, file in zip(pairs, files, strict=True):
        surface, contact = pair.surface, pair.contact
        path = None if contact.modulus_file is None else campaign.raw / contact.modulus_file
        read_as = (contact.sweep, contact.modulus_unit)
        scans = scans_of(campaign, surface)
        instrument = surface.instrument and instrument_of(campaign, surface.instrument)
        facts: Arguments = {
            "name": pair.label,
            "data_file": f"data/{file}.nc",
            "instrument": instrument,
            "roughness": campaign.roughness.model_dump(exclude_none=True),
            "contact": contact.bodies(),
            "area": campaign.model.area,
            "forces": tuple(
                sorted({*stated, *(force for name, force in known if name == pair.label)})
            ),
            "lowest_force": min(every, default=None),
            "media": media,
            "rubber": campaign.rubber.model_dump(),
            "rubber_work": campaign.medium[sticky].work_of_adhesion if sticky else None,
            "quality": campaign.qc.scan_options(),
        }
        shaping = facts | {
            "media": [asdict(medium) for medium in media],
            "instrument": surface.instrument,
            "dialect": instrument and sha256_of_dialect(instrument),
            "modulus": path and sha256_of_file(path),
            "modulus_read": read_as,
        }
        planned.append(
            PlannedSurface(
                patterns=surface.scans or (),
                files=tuple(scans),
                labels=tuple(label_of(campaign, scan) for scan in scans),
                modulus_file=None if path is None else (path, label_of(campaign, path)),
                modulus_read=read_as,
                config_sha256=sha256_of(shaping),
                **facts,
            )
        )
    return tuple(planned)
