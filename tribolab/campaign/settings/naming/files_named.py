"""Labels from the names of raw files: surface, medium, load, speed, mount, repeat."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.campaign.settings.files import matching_files
from tribolab.campaign.settings.measured import Medium, Surface
from tribolab.campaign.settings.name_pattern import NamePattern
from tribolab.campaign.settings.naming.run_names import common_name
from tribolab.core.errors import UnitError
from tribolab.core.wording import is_dry
from tribolab.units.conversion import to_si

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign

_AMOUNTS = {"normal_force": "N", "sliding_speed": "m/s"}


class Named(NamedTuple):
    """Properties of a run from the names of its files; "" or None if not named."""

    surface: str = ""
    medium: str = ""
    mount: str = ""
    specimen: str = ""
    normal_force: float | None = None
    sliding_speed: float | None = None


def named_by_files(pattern: str | None, files: Sequence[Path]) -> Named:
    """Return the properties of a run that are stated in the names of its files.

    Parameters
    ----------
    pattern
        ``files_named`` of the campaign file, e.g. "{surface}_{medium}_{normal_force}_{repeat}".
    files
        Files of one run.

    Examples
    --------
    >>> pattern = "{surface}_{medium}_{normal_force}_{repeat}"
    >>> named_by_files(pattern, [Path("sb-r_water_31N_02.csv")])[:2]
    ('sb-r', 'water')
    >>> named_by_files(pattern, [Path("sb-r_water_31N_02.csv")]).normal_force
    31.0
    """
    if pattern is None:
        return Named()
    labels = NamePattern(pattern).labels(common_name(files))
    amounts = {}
    for name, unit in _AMOUNTS.items():
        try:
            amounts[name] = to_si(labels.get(name, ""), unit, name=name)
        except UnitError:
            continue
    return Named(
        labels.get("surface", ""),
        labels.get("medium", ""),
        labels.get("mount", ""),
        labels.get("specimen", ""),
        amounts.get("normal_force"),
        amounts.get("sliding_speed"),
    )


def with_named_parts(campaign: Campaign) -> Campaign:
    """Add the surfaces and media that are named only in file names to a campaign."""
    pattern = campaign.campaign.files_named
    if pattern is None:
        return campaign
    files = [
        file
        for entry in campaign.run
        for each in entry.files
        for file in matching_files(campaign.raw, each)
    ]
    named = [named_by_files(pattern, [file]) for file in files]
    known = {surface.name for surface in campaign.surface}
    surfaces = [Surface(name=name) for name in _new((each.surface for each in named), known)]
    media = {name: Medium() for name in _new((each.medium for each in named), campaign.medium)}
    return campaign.model_copy(
        update={
            "surface": (*campaign.surface, *surfaces),
            "medium": {**campaign.medium, **media},
        }
    )


def _new(names: Iterable[str], known: Iterable[str]) -> list[str]:
    return [name for name in dict.fromkeys(names) if name and name not in set(known)]


def pattern_of_names(names: Sequence[str]) -> str | None:
    """Return the pattern that the file names of the runs follow; None if there is none.

    Parameters
    ----------
    names
        Names of the files without extension.

    Examples
    --------
    >>> pattern_of_names(["silicone_water_5N_1", "silicone_water_5N_2"])
    '{surface}_{medium}_{normal_force}_{repeat}'
    >>> pattern_of_names(["POD_PTFE_steel_1", "POD_PTFE_steel_2"]), pattern_of_names(["a", "b7"])
    ('{surface}_{repeat}', None)
    >>> pattern_of_names(["gel-water-1", "gel-water-2"]), pattern_of_names(["gel 1", "gel 2"])
    ('{surface}-{medium}-{repeat}', '{surface} {repeat}')
    """
    patterns = (_pattern_parted_by(mark, names) for mark in "_- ")
    return next(filter(None, patterns), None)


def _pattern_parted_by(mark: str, names: Sequence[str]) -> str | None:
    """Return the pattern of names whose labels are separated by `mark`; None if there is none."""
    rows = [name.split(mark) for name in names]
    found: list[str] = []
    while rows and min(map(len, rows)) > 1:
        label = _label_of([row[-1] for row in rows])
        if not label or label in found or (label == "repeat" and found):
            break
        found.insert(0, label)
        rows = [row[:-1] for row in rows]
    if not found:
        return None
    return mark.join(f"{{{label}}}" for label in ("surface", *found))


def _label_of(words: Sequence[str]) -> str:
    """Return the label of the last words of names: repeat, load, speed or medium; else ""."""
    if all(word.lstrip("rR").isdigit() for word in words):
        return "repeat"
    for label, unit in _AMOUNTS.items():
        try:
            if all(word[:1].isdigit() and to_si(word, unit, name=label) > 0 for word in words):
                return label
        except UnitError:
            continue
    from tribolab.lubrication.viscosity import knows_liquid  # imported late for a quick start

    liquids = ("oil", "pbs", "saline", "air")
    if all(is_dry(word) or knows_liquid(word) or word.lower() in liquids for word in words):
        return "medium"
    return ""
