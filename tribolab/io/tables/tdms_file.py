"""LabVIEW TDMS files, opened; a damaged one is an error that says so."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribolab.errors import ReadError, brief
from tribolab.io.key_words import UNIT_KEYS
from tribolab.io.tables.settings_text import setting_lines, text_of

_DAMAGE = (
    *(ValueError, KeyError, IndexError, TypeError, OSError, EOFError, struct.error),
    *(MemoryError, OverflowError, NotImplementedError, AttributeError),
)

# how the text of a TDMS file says the time from row to row
INCREMENT_PATTERN = r"^wf_increment: (\S+)"
_UNITS = ("unit_string", "NI_UnitDescription", "Unit", *UNIT_KEYS)
_WHOLE = 1e-3  # of an interval, how far the ratio of two may be from a whole number


class Grid(NamedTuple):
    """Channels as numbers at the same moments, NaN between those of slower ones; the interval."""

    values: list[np.ndarray]
    increment: float


def on_one_grid(channels: list[Any]) -> Grid | None:
    """Bring channels that have a clock of their own (waveforms) to that of the fastest.

    Parameters
    ----------
    channels
        From nptdms.

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
    values = [np.asarray(channel[:]) for channel in channels]
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


def properties_of(item: Any) -> list[str]:
    """Return the properties of a file or a group as lines."""
    return [line for key, value in item.properties.items() for line in setting_lines(key, value)]


def text_beside(file: Any, groups: Iterable[Any], increment: float) -> str:
    """Return what a file says beside its channels, as the text of a file stands above a table.

    Parameters
    ----------
    file, groups
        From nptdms: the file, and those of its groups whose channels are read.
    increment
        The time [s] from row to row; 0 where there is none for all.
    """
    clock = [f"wf_increment: {increment!r}"] if increment else []
    own = [f"{key}: {value}" for key, value in file.properties.items()]
    more = [line for item in (file, *groups) for line in properties_of(item)]
    return text_of([*clock, *own, *more])


def unit_of(channel: Any) -> str | None:
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
    file = open_tdms(path, "read_metadata")
    return {f"{g.name}/{c.name}" for g in file.groups() for c in g.channels()}


def open_tdms(path: Path, how: str) -> Any:
    """Open a TDMS file by one of `nptdms.TdmsFile`'s ways: ``"read"``, ``"read_metadata"``.

    Raises
    ------
    ReadError
        If the file is damaged, or nptdms is not installed.
    """
    try:
        # late: nptdms takes long to load
        from nptdms import TdmsFile
    except ImportError as error:
        raise ReadError(
            f"{path}: TDMS files need the package nptdms: pip install 'tribolab[formats]'"
        ) from error
    try:
        return getattr(TdmsFile, how)(str(path))
    except _DAMAGE as error:
        raise ReadError(
            f"{path}: the TDMS file is damaged: {brief(error)}; copy or save it again"
        ) from error
