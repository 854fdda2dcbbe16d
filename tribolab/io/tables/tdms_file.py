"""LabVIEW TDMS files, opened; a damaged one is an error that says so."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribolab.io.tables.settings_text import setting_lines, text_of
from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.opening import damage_told, isolated

Settings = dict[str, int | float | str]
# how the text of a TDMS file says the time from row to row
INCREMENT_PATTERN = r"^wf_increment: (\S+)"
_UNITS = ("unit_string", "NI_UnitDescription", "Unit", *keys_of("unit"))
_WHOLE = 1e-3  # of an interval, how far the ratio of two may be from a whole number


class Grid(NamedTuple):
    """Channels as numbers at the same moments, NaN between those of slower ones; the interval."""

    values: list[np.ndarray]
    increment: float


class Channel(NamedTuple):
    """A channel: names of it and its group, what its properties say, its values."""

    name: str
    group_name: str
    properties: Settings
    values: np.ndarray


class Group(NamedTuple):
    """A group of channels, with what its properties say."""

    name: str
    properties: Settings
    channels: list[Channel]


class TdmsContent(NamedTuple):
    """What a TDMS file holds; whether it ends within its last segment."""

    properties: Settings
    groups: list[Group]
    incomplete: bool


def on_one_grid(channels: list[Channel]) -> Grid | None:
    """Bring channels that have a clock of their own (waveforms) to that of the fastest.

    Parameters
    ----------
    channels
        From `open_tdms`.

    Returns
    -------
    Grid or None
        None unless all have a clock, they start together, and the slower ones tick at whole
        numbers of the fastest one's intervals.
    """
    steps = [_number(channel.properties.get("wf_increment")) for channel in channels]
    starts = {
        (str(c.properties.get("wf_start_time")), str(c.properties.get("wf_start_offset", 0.0)))
        for c in channels
    }
    values = [channel.values for channel in channels]
    if not values or len(starts) > 1 or not all(step > 0 for step in steps):
        return None
    if any(v.dtype.kind not in "fiu" or not v.size for v in values):
        return None
    finest = min(steps)
    ratios = [round(step / finest) for step in steps]
    if any(abs(s / finest - r) > _WHOLE for s, r in zip(steps, ratios, strict=True)):
        return None
    size = max(v.size for v, r in zip(values, ratios, strict=True) if r == 1)
    spread = []
    for numbers, ratio in zip(values, ratios, strict=True):
        cells = np.full(size, np.nan)
        taken = numbers[: -(-size // ratio)]
        cells[: taken.size * ratio : ratio] = taken
        spread.append(cells)
    return Grid(spread, finest)


def _number(said: object) -> float:
    return float(said) if isinstance(said, int | float) and np.isfinite(said) else 0.0


def properties_of(item: Group | TdmsContent) -> list[str]:
    """Return the properties of a file or a group as lines."""
    return [line for key, value in item.properties.items() for line in setting_lines(key, value)]


def text_beside(file: TdmsContent, groups: Iterable[Group], increment: float) -> str:
    """Return what a file says beside its channels, as the text of a file stands above a table.

    Parameters
    ----------
    file, groups
        From `open_tdms`: the file, and those of its groups whose channels are read.
    increment
        The time [s] from row to row; 0 where there is none for all.
    """
    clock = [f"wf_increment: {increment!r}"] if increment else []
    own = [f"{key}: {value}" for key, value in file.properties.items()]
    own = [f"{key}: {value}" for key, value in file.properties.items()]
    more = properties_of(file) + [line for group in groups for line in properties_of(group)]
    return text_of([*clock, *own, *more])


def unit_of(channel: Channel) -> str | None:
    """Return the unit that a channel's properties say; None if none."""
    said = (str(channel.properties.get(key, "")).strip() for key in _UNITS)
    return next((unit for unit in said if unit), None)


def channel_names(path: Path) -> set[str]:
    """Names of the channels of a TDMS file as ``group/channel``.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    file = open_tdms(path, values=False)
    return {f"{group.name}/{channel.name}" for group in file.groups for channel in group.channels}


@isolated("nptdms")
def open_tdms(path: Path, *, values: bool = True) -> TdmsContent:
    """Read a TDMS file, or the names and properties of its channels alone.

    An index file beside it is not looked at.

    Raises
    ------
    ReadError
        If the file is damaged, or nptdms is not installed.
    """
    # late: nptdms takes long to load
    from nptdms import TdmsFile

    with damage_told(path, "TDMS file"), path.open("rb") as stream:
        file = (TdmsFile.read if values else TdmsFile.read_metadata)(stream)
        groups = [
            Group(
                group.name,
                _plain(group.properties),
                [
                    Channel(
                        channel.name,
                        group.name,
                        _plain(channel.properties),
                        np.asarray(channel[:]) if values and len(channel) else np.empty(0),
                    )
                    for channel in group.channels()
                ],
            )
            for group in file.groups()
        ]
        incomplete = bool(file.file_status.incomplete_final_segment)
        return TdmsContent(_plain(file.properties), groups, incomplete)


def _plain(properties: Mapping[str, Any]) -> Settings:
    kinds = (int, float, str)
    return {
        str(key): value if isinstance(value, kinds) else str(value)
        for key, value in properties.items()
    }
