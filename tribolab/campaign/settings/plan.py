"""Plan of the runs of a campaign: files, names and settings of each."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.campaign.settings.contact_pairs import pair_label
from tribolab.campaign.settings.files import (
    instrument_of,
    label_of,
    matching_files,
    resolve_patterns,
    sha256_of_dialect,
)
from tribolab.campaign.settings.naming.files_named import named_by_files
from tribolab.campaign.settings.naming.run_names import unique_names
from tribolab.campaign.settings.problems import SettingsProblem, message
from tribolab.campaign.settings.review import read_decisions
from tribolab.campaign.settings.toml_lines import line_of
from tribolab.core.errors import ConfigError
from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.core.untyped import Arguments, Json
from tribolab.friction.decisions.decision import Decision
from tribolab.reading.dialect.zero_reading import parse_zero

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import RunEntry


@dataclass(frozen=True)
class PlannedRun:
    """Run to be processed, with everything that a worker needs.

    Parameters
    ----------
    name
        Name of the run, unique in the campaign and valid as a file name.
    files
        Raw files, absolute.
    labels
        The same relative to the campaign file, as reports show them.
    surface, medium, mount, specimen
        Labels of the run; "" if not stated.
    zero_uncertainty_at
        File, line and number of the [[run]] that states it.
    normal_force, sliding_speed
        Set-points [N, m/s], if the campaign file gives them.
    clock_shift
        Time to add to the clock of the second log [s], if stated.
    instrument
        Name of a dialect or path of its TOML file; None if it is recognised from the files.
    zero
        Where the zero of the friction signal is read, see `tribolab.read`.
    moving_mass
        Mass between contact and force sensor [kg], if stated.
    stiffness
        Stiffness of the rig in the direction of sliding [N/m], if stated.
    contact_area
        Measured contact area [m2], if the campaign file gives it.
    dead_weight
        Dead weight that loads this reference run [N], if stated.
    segments, friction
        Arguments of `find_segments` and `friction_coefficient`.
    quality
        Arguments of `check_run`: limits, skip, contact_width.
    uncertainty
        Standard uncertainties that the campaign file states, by name, in SI.
    config_sha256
        Checksum of all of these, and of the dialect's content.
    reading_sha256
        Checksum of the settings that affect the reading of the files.
    decisions
        Decisions of a person on the run.
    """

    name: str
    files: tuple[Path, ...]
    labels: tuple[str, ...]
    surface: str
    medium: str
    normal_force: float | None
    sliding_speed: float | None
    clock_shift: float | None
    instrument: str | None
    zero: str | None = None
    moving_mass: float | None = None
    stiffness: float | None = None
    contact_area: float | None = None
    dead_weight: float | None = None
    segments: Arguments = field(default_factory=dict)
    friction: Arguments = field(default_factory=dict)
    quality: Arguments = field(default_factory=dict)
    uncertainty: Arguments = field(default_factory=dict)
    mount: str = ""
    specimen: str = ""
    zero_uncertainty_at: str = ""
    config_sha256: str = ""
    reading_sha256: str = ""
    decisions: tuple[Decision, ...] = ()


class Plan(NamedTuple):
    """Planned runs of a campaign, and the problems with its file patterns."""

    runs: tuple[PlannedRun, ...]
    problems: list[SettingsProblem]


def plan_runs(campaign: Campaign) -> Plan:
    """Find the files of all runs and plan the runs, in the order of the campaign file."""
    if not campaign.raw.is_dir():
        what = f"there is no folder {campaign.raw}"
        return Plan((), [SettingsProblem(("campaign", "raw"), what)])
    problems: list[SettingsProblem] = []
    groups: list[tuple[RunEntry, list[Path]]] = []
    owner: dict[Path, int] = {}
    for number, surface in enumerate(campaign.surface):
        resolve_patterns(campaign.raw, surface.scans or (), ("surface", number, "scans"), problems)
    problems += _of_moduli(campaign)
    for number, entry in enumerate(campaign.run):
        where = ("run", number, "files")
        files = resolve_patterns(campaign.raw, entry.files, where, problems)
        for file in files:
            if (other := owner.setdefault(file, number)) != number:
                what = f"{label_of(campaign, file)} belongs to run {other + 1} already"
                problems.append(SettingsProblem(where, what))
                break
        groups += [(entry, group) for group in _groups(campaign, entry, files)]
    if problems:
        return Plan((), problems)
    names = unique_names([files for _, files in groups])
    settings = {id(entry): _settings(campaign, entry) for entry in campaign.run}
    places = {id(entry): _zero_stated_at(campaign, k) for k, entry in enumerate(campaign.run)}
    decisions = read_decisions(campaign.file)
    reference = campaign.reference
    under = reference.files if reference.dead_weight is not None else None
    weighed = {file for pattern in under or () for file in matching_files(campaign.raw, pattern)}
    runs = tuple(
        _decided(
            _weighed(
                _in_contact(
                    _named(
                        PlannedRun(
                            name=name,
                            files=tuple(files),
                            labels=tuple(label_of(campaign, file) for file in files),
                            mount=entry.labels.get("mount", ""),
                            specimen=entry.labels.get("specimen", ""),
                            zero_uncertainty_at=places[id(entry)],
                            **settings[id(entry)],
                        ),
                        campaign,
                    ),
                    entry.contact or "",
                ),
                campaign,
                weighed,
            ),
            decisions.get(name, ()),
        )
        for (entry, files), name in zip(groups, names, strict=True)
    )
    return Plan(runs, [])


def _of_moduli(campaign: Campaign) -> list[SettingsProblem]:
    """Return a problem for each modulus_file that does not exist or is not a regular file."""
    problems = []
    tables = {(): campaign.contact} | {(n,): t for n, t in campaign.contact.named.items()}
    for where, contact in tables.items():
        if (name := contact.modulus_file) and not (campaign.raw / name).is_file():
            there = (campaign.raw / name).exists()
            what = f"{'no regular' if there else 'there is no'} file {campaign.raw / name}"
            problems.append(SettingsProblem(("contact", *where, "modulus_file"), what))
    return problems


def _in_contact(run: PlannedRun, contact: str) -> PlannedRun:
    """Add the name of the contact to the surface of a run, if the contact has a name."""
    if not contact:
        return run
    mark = sha256_of([run.config_sha256, contact])
    return replace(run, surface=pair_label(run.surface, contact), config_sha256=mark)


def _zero_stated_at(campaign: Campaign, number: int) -> str:
    """Return file, line and [[run]] that state zero_uncertainty, for error messages."""
    if campaign.run[number].zero_uncertainty is None:
        return ""
    text = campaign.file.read_text(encoding="utf-8") if campaign.file.is_file() else ""
    line = line_of(text, ["run", number, "zero_uncertainty"])
    at = f", line {line}" if line else ""
    return f"{campaign.file.name}{at}, [[run]] {number + 1}"


def _named(run: PlannedRun, campaign: Campaign) -> PlannedRun:
    """Add the properties in the file names to a run, unless they are stated elsewhere."""
    named = named_by_files(campaign.campaign.files_named, run.files)._asdict()
    from_name = {key: value for key, value in named.items() if value and not getattr(run, key)}
    if not from_name:
        return run
    return replace(run, **from_name, config_sha256=sha256_of([run.config_sha256, from_name]))


def _weighed(run: PlannedRun, campaign: Campaign, weighed: set[Path]) -> PlannedRun:
    """Add the dead weight to a reference run; such a run need not contain sliding."""
    weight = campaign.reference.dead_weight
    if weight is None or weighed.isdisjoint(run.files):
        return run
    mark = sha256_of([run.config_sha256, weight])
    quality = run.quality | {"skip": [*run.quality.get("skip", ()), "segments"]}
    return replace(run, dead_weight=weight, quality=quality, config_sha256=mark)


def _decided(run: PlannedRun, decisions: tuple[Decision, ...]) -> PlannedRun:
    """Add a person's decisions to a run; its checksum depends on its own decisions only."""
    if not decisions:
        return run
    shaping = [run.config_sha256, *(decision.plain() for decision in decisions)]
    return replace(run, decisions=decisions, config_sha256=sha256_of(shaping))


def planned_runs(campaign: Campaign) -> tuple[PlannedRun, ...]:
    """Return the runs of a campaign.

    Raises
    ------
    ConfigError
        If a pattern matches no file.
    """
    resolved = plan_runs(campaign)
    if resolved.problems:
        text = campaign.file.read_text("utf-8-sig")
        raise ConfigError(message(resolved.problems, campaign.file, text))
    return resolved.runs


def _groups(campaign: Campaign, entry: RunEntry, files: list[Path]) -> list[list[Path]]:
    if entry.cycles:
        return [files]
    from tribolab.reading.runs.logs import group_files  # imported late for a quick start

    instrument = entry.instrument and instrument_of(campaign, entry.instrument)
    return group_files(files, instrument)


def _zero(campaign: Campaign, entry: RunEntry) -> tuple[str | None, list[Path]]:
    """Return where the zero is read, and the files of blank runs that provide zeros."""
    if entry.zero is not None:
        name = parse_zero(entry.zero).file
        blank = campaign.raw / name
        return (f"file {blank}", [blank]) if name else (entry.zero, [])
    if not entry.instrument:
        return None, []
    from tribolab.reading.dialect.find import load_dialect  # an unchanged campaign may not need it

    dialect = load_dialect(instrument_of(campaign, entry.instrument))
    rules = [parse_zero(column.zero) for column in dialect.column if column.zero]
    return None, [campaign.raw / rule.file for rule in rules if rule.file]


def _settings(campaign: Campaign, entry: RunEntry) -> Json:
    """Return the settings shared by all runs of a [[run]] table, with their checksums."""
    instrument = entry.instrument and instrument_of(campaign, entry.instrument)
    zero, blanks = _zero(campaign, entry)
    settings: Json = {
        "surface": entry.surface or "",
        "medium": entry.medium or "",
        "normal_force": entry.normal_force,
        "sliding_speed": entry.sliding_speed,
        "clock_shift": entry.clock_shift,
        "zero": zero,
        "moving_mass": entry.moving_mass,
        "stiffness": entry.stiffness,
        "contact_area": entry.contact_area,
        "segments": campaign.segment_options(entry),
        "friction": campaign.friction_options(entry),
        "quality": campaign.quality_options(entry),
        "uncertainty": campaign.uncertainty.plain(),
    }
    reading = {
        "instrument": entry.instrument,
        "dialect": instrument and sha256_of_dialect(instrument),
        "cycles": entry.cycles,
        "clock_shift": entry.clock_shift,
        "zero": zero,
        "moving_mass": entry.moving_mass,
        "blank": [sha256_of_file(blank) if blank.is_file() else "" for blank in blanks],
    }
    mounts = [entry.labels.get("mount"), entry.labels.get("specimen")]
    return settings | {
        "instrument": instrument,
        "config_sha256": sha256_of(settings | reading | {"mount": mounts}),
        "reading_sha256": sha256_of(reading),
    }
