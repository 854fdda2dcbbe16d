"""Which files make which run: patterns resolved, names given, settings collected."""

from __future__ import annotations

import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.campaign.settings.name_pattern import NamePattern
from tribolab.campaign.settings.problems import Problem, message
from tribolab.campaign.settings.review import REVIEW_FILE, review_beside
from tribolab.errors import ConfigError, nearest, shown
from tribolab.friction.decisions.decision import Decision
from tribolab.io.zero_reading import parse_zero
from tribolab.provenance import as_text, sha256_of, sha256_of_file
from tribolab.untyped import Arguments, Json

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign, RunEntry, Surface

_LONGEST_NAME = 100


@dataclass(frozen=True)
class PlannedRun:
    """One run to be processed: all that a worker needs to know.

    Parameters
    ----------
    name
        Unique in the campaign, safe as a file name.
    files
        Raw files, absolute.
    labels
        The same relative to the campaign file, as reports show them.
    surface, medium, mount
        "" where the campaign file says nothing.
    normal_force, sliding_speed
        Set-points [N, m/s], if the campaign file gives them.
    clock_shift
        Between the clocks of the two logs [s], if the campaign file gives it.
    instrument
        Name of a dialect, or path of a dialect's TOML file, or None: the files tell.
    zero
        Where the zero of the friction signal is read, see `tribolab.read`.
    moving_mass
        Between contact and force sensor [kg], if the campaign file gives it.
    dead_weight
        Of the reference that it is a run of [N], where one is stated.
    segments, friction
        Arguments of `find_segments` and `friction_coefficient`.
    quality
        Arguments of `check_run`: limits, skip, contact_width.
    uncertainty
        Standard uncertainties that the campaign file states, by name, in SI.
    config_sha256
        Checksum of all of these, and of the dialect's content.
    reading_sha256
        Checksum of those of them that reading the files depends on.
    decisions
        What a person decided on it.
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
    dead_weight: float | None = None
    segments: Arguments = field(default_factory=dict)
    friction: Arguments = field(default_factory=dict)
    quality: Arguments = field(default_factory=dict)
    uncertainty: Arguments = field(default_factory=dict)
    mount: str = ""
    config_sha256: str = ""
    reading_sha256: str = ""
    decisions: tuple[Decision, ...] = ()


class Plan(NamedTuple):
    """The runs of a campaign, and what is wrong with its patterns."""

    runs: tuple[PlannedRun, ...]
    problems: list[Problem]


def plan_runs(campaign: Campaign) -> Plan:
    """Resolve the patterns of a campaign into runs, in the order of the campaign file."""
    if not campaign.raw.is_dir():
        what = f"there is no folder {campaign.raw}"
        return Plan((), [Problem(("campaign", "raw"), what)])
    problems: list[Problem] = []
    groups: list[tuple[RunEntry, list[Path]]] = []
    owner: dict[Path, int] = {}
    for number, surface in enumerate(campaign.surface):
        _resolve(campaign.raw, surface.scans or (), ("surface", number, "scans"), problems)
    if (name := campaign.contact.modulus_file) and not (campaign.raw / name).is_file():
        what = f"there is no file {campaign.raw / name}"
        problems.append(Problem(("contact", "modulus_file"), what))
    for number, entry in enumerate(campaign.run):
        where = ("run", number, "files")
        files = _resolve(campaign.raw, entry.files, where, problems)
        for file in files:
            if (other := owner.setdefault(file, number)) != number:
                what = f"{label_of(campaign, file)} belongs to run {other + 1} already"
                problems.append(Problem(where, what))
                break
        groups += [(entry, group) for group in _groups(campaign, entry, files)]
    if problems:
        return Plan((), problems)
    names = unique_names([files for _, files in groups])
    settings = {id(entry): _settings(campaign, entry) for entry in campaign.run}
    decisions = review_beside(campaign.file)
    reference = campaign.reference
    under = reference.files if reference.dead_weight is not None else None
    weighed = {file for pattern in under or () for file in _matching(campaign.raw, pattern)}
    runs = tuple(
        _decided(
            _weighed(
                PlannedRun(
                    name=name,
                    files=tuple(files),
                    labels=tuple(label_of(campaign, file) for file in files),
                    mount=_mount(entry, files[0]),
                    **settings[id(entry)],
                ),
                campaign,
                weighed,
            ),
            decisions.get(name, ()),
        )
        for (entry, files), name in zip(groups, names, strict=True)
    )
    return Plan(runs, [])


def _mount(entry: RunEntry, file: Path) -> str:
    """Return which mounting of the specimen a run belongs to, stated or in the file's name."""
    if entry.mount is not None or entry.labels_in_name is None:
        return entry.mount or ""
    return NamePattern(entry.labels_in_name).labels(file.stem).get("mount", "")


def _weighed(run: PlannedRun, campaign: Campaign, weighed: set[Path]) -> PlannedRun:
    """Return a run of a reference with its dead weight: it need not slide."""
    weight = campaign.reference.dead_weight
    if weight is None or weighed.isdisjoint(run.files):
        return run
    mark = sha256_of([run.config_sha256, weight])
    quality = run.quality | {"skip": [*run.quality.get("skip", ()), "segments"]}
    return replace(run, dead_weight=weight, quality=quality, config_sha256=mark)


def _decided(run: PlannedRun, decisions: tuple[Decision, ...]) -> PlannedRun:
    """Return a run with what was decided on it; its checksum tells of these decisions alone."""
    if not decisions:
        return run
    shaping = [run.config_sha256, *(decision.plain() for decision in decisions)]
    return replace(run, decisions=decisions, config_sha256=sha256_of(shaping))


def planned_runs(campaign: Campaign) -> tuple[PlannedRun, ...]:
    """Return the runs of a campaign.

    Raises
    ------
    ConfigError
        If its patterns match nothing.
    """
    resolved = plan_runs(campaign)
    if resolved.problems:
        text = campaign.file.read_text("utf-8-sig")
        raise ConfigError(message(resolved.problems, campaign.file, text))
    return resolved.runs


def scan_files(campaign: Campaign) -> list[Path]:
    """Return the topography scans of all surfaces."""
    return [path for surface in campaign.surface for path in scans_of(campaign, surface)]


def scans_of(campaign: Campaign, surface: Surface) -> list[Path]:
    """Return the topography scans of one surface, each once."""
    named = (path for pattern in surface.scans or () for path in _matching(campaign.raw, pattern))
    return list(dict.fromkeys(named))


def inputs_of(campaign: Campaign) -> list[tuple[Path, str]]:
    """Return every file that a campaign reads, and what it is in words."""
    inputs = [(campaign.file, "the campaign file")]
    inputs.append((campaign.file.parent / REVIEW_FILE, "the review file"))
    for entry in campaign.run:
        inputs += [(f, "a raw file") for p in entry.files for f in _matching(campaign.raw, p)]
    inputs += [(file, "a scan") for file in scan_files(campaign)]
    if (name := campaign.contact.modulus_file) is not None:
        inputs.append((campaign.raw / name, "the modulus file"))
    instruments = [entry.instrument for entry in campaign.run]
    instruments += [surface.instrument for surface in campaign.surface]
    for instrument in instruments:
        if instrument and instrument.endswith(".toml"):
            inputs.append((Path(instrument_of(campaign, instrument)), "a dialect"))
    return inputs


def instrument_of(campaign: Campaign, name: str) -> str:
    """Name of a dialect as it is; a dialect's own file relative to the campaign file."""
    return str(campaign.file.parent / name) if name.endswith(".toml") else name


def _resolve(
    raw: Path, patterns: Iterable[str], where: tuple[str | int, ...], problems: list[Problem]
) -> list[Path]:
    files: dict[Path, None] = {}
    for pattern in patterns:
        matching = _matching(raw, pattern)
        if not matching:
            problems.append(
                Problem(where, f"nothing matches '{shown(pattern)}' in {raw}{_there(raw, pattern)}")
            )
        files.update(dict.fromkeys(matching))
    return list(files)


def _matching(raw: Path, pattern: str) -> list[Path]:
    exact = raw / pattern
    try:
        if exact.is_file():  # brackets in a real name are no wildcards
            return [exact]
        files = [path for path in raw.glob(pattern) if path.is_file()]
    except (OSError, ValueError, NotImplementedError):  # absolute, empty, or too long a name
        return []
    return sorted(files, key=lambda path: _natural(str(path)))


def _natural(text: str) -> list[tuple[bool, int, str]]:
    """Key under which cycle 2 comes before cycle 10."""
    return [
        (part.isdigit(), int(part) if part.isdigit() else 0, part)
        for part in re.split(r"(\d+)", text)
    ]


def _there(raw: Path, pattern: str) -> str:
    """Say what is in the folder where the pattern stops to match, or that it names that folder."""
    parts = Path(pattern).parts
    if len(parts) > 1 and parts[0] == raw.name and not _is_folder(raw / parts[0]):
        return f"; patterns are relative to {raw.name}/: leave '{raw.name}/' out"
    folder = raw
    for part in Path(pattern).parts[:-1]:
        if not _is_folder(folder / part):
            break
        folder /= part
    names = sorted(f"{p.name}/" if p.is_dir() else p.name for p in folder.iterdir())
    if not names:
        return f"; {folder} is empty"
    hint = nearest(Path(pattern).name, names)
    listed = ", ".join(map(shown, names[:5])) + (
        f", ... ({len(names)} in all)" if len(names) > 5 else ""
    )
    in_folder = "" if folder == raw else f" in {folder.relative_to(raw)}/"
    return f"; there is{in_folder} {listed}" + (hint if "did you mean" in hint else "")


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):  # no name that a folder could have
        return False


def _groups(campaign: Campaign, entry: RunEntry, files: list[Path]) -> list[list[Path]]:
    if entry.cycles:
        return [files]
    from tribolab.io.logs import group_files

    instrument = entry.instrument and instrument_of(campaign, entry.instrument)
    return group_files(files, instrument)


def _zero(campaign: Campaign, entry: RunEntry) -> tuple[str | None, list[Path]]:
    """Where the zero is read, and the blank runs in the raw folder that zeros are read from."""
    if entry.zero is not None:
        name = parse_zero(entry.zero).file
        blank = campaign.raw / name
        return (f"file {blank}", [blank]) if name else (entry.zero, [])
    if not entry.instrument:
        return None, []
    from tribolab.io.dialects.find import load_dialect  # an unchanged campaign may not need it

    dialect = load_dialect(instrument_of(campaign, entry.instrument))
    rules = [parse_zero(column.zero) for column in dialect.column if column.zero]
    return None, [campaign.raw / rule.file for rule in rules if rule.file]


def _settings(campaign: Campaign, entry: RunEntry) -> Json:
    """Return what all runs of an entry share, with its checksum."""
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
    mounts = [entry.mount, entry.labels_in_name]
    return settings | {
        "instrument": instrument,
        "config_sha256": sha256_of(settings | reading | {"mount": mounts}),
        "reading_sha256": sha256_of(reading),
    }


def sha256_of_dialect(instrument: str) -> str:
    """Return the checksum of what describes an instrument."""
    from tribolab.io.dialects.find import known_dialects

    return sha256_of_file(known_dialects().get(instrument, instrument))


def label_of(campaign: Campaign, file: Path) -> str:
    """Return a file relative to the campaign file, as reports show it."""
    return as_text(Path(os.path.relpath(file, campaign.file.parent)).as_posix())


def unique_names(groups: Iterable[Iterable[Path]]) -> list[str]:
    """One name per run, from what its files' names have in common; safe on any file system.

    Examples
    --------
    >>> unique_names([[Path("a/x_1_force.csv"), Path("a/x_1_motion.csv")], [Path("b/x_1.csv")]])
    ['a_x_1', 'b_x_1']
    """
    members = [list(group) for group in groups]
    names = [safe_name(_common(files)) for files in members]
    taken = Counter(name.casefold() for name in names)
    names = [
        safe_name(f"{files[0].parent.name}_{name}") if taken[name.casefold()] > 1 else name
        for name, files in zip(names, members, strict=True)
    ]
    return distinct(names)


def distinct(names: Iterable[str]) -> list[str]:
    """Add numbers to names that came before; upper and lower case are one on some disks.

    Examples
    --------
    >>> distinct(["a", "A", "b"])
    ['a', 'A_2', 'b']
    """
    seen: set[str] = set()
    result = []
    for name in names:
        candidate, number = name, 2
        while candidate.casefold() in seen:
            candidate, number = f"{name}_{number}", number + 1
        seen.add(candidate.casefold())
        result.append(candidate)
    return result


def _common(files: list[Path]) -> str:
    stems = [file.stem for file in files]
    if len(stems) == 1:
        return stems[0]
    prefix = os.path.commonprefix(stems)
    if any(len(stem) > len(prefix) and stem[len(prefix)].isalnum() for stem in stems):
        prefix = re.sub(r"[^\W_]+$", "", prefix)  # not in the middle of a word or number
    return prefix.rstrip(" _-.") or stems[0]


def safe_name(name: str) -> str:
    """Return a name that any file system takes.

    Examples
    --------
    >>> safe_name("Sb-R, glycerol 5 µm/s")
    'Sb-R_glycerol_5_um_s'
    """
    plain = unicodedata.normalize("NFKD", name.replace("µ", "u").replace("μ", "u"))
    plain = plain.encode("ascii", "ignore").decode()
    plain = re.sub(r"[^A-Za-z0-9._-]+", "_", plain).strip("._")[:_LONGEST_NAME] or "run"
    # "curve_" and "surface_" begin what other results are called; the rest are devices on Windows
    clash = re.match(r"(?i)(curve_|surface_|(con|prn|aux|nul|com\d|lpt\d)(\.|$))", plain)
    return f"run_{plain}" if clash else plain
