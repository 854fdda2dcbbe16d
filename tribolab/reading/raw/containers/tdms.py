"""LabVIEW TDMS: groups of channels, which may have separate clocks (waveforms)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.containers.groups import Groups, settings_of
from tribolab.reading.raw.model import Clock, RawColumn, RawFile
from tribolab.reading.raw.opening import isolated, report_damage

_UNITS = ("unit_string", "NI_UnitDescription", "Unit", *keys_of("unit"))


def channel_names(path: Path) -> set[str]:
    """Return the names of the channels of a TDMS file as ``group/channel``.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    file = read_tdms(path, values=False)
    return {column.path for table in file.tables for column in table.columns}


@isolated("nptdms")
def read_tdms(path: Path, *, values: bool = True) -> RawFile:
    """Read a TDMS file, or only the names and properties of its channels.

    An index file next to it is not used. The clock of a waveform is stated by its properties
    ``wf_start_time``, ``wf_start_offset`` and ``wf_increment``; times count from the first start in
    the file.

    Raises
    ------
    ReadError
        If the file is damaged, or nptdms is not installed.
    """
    # imported late: nptdms loads slowly
    from nptdms import TdmsFile

    groups = Groups()
    with report_damage(path, "TDMS file"), path.open("rb") as stream:
        file = (TdmsFile.read if values else TdmsFile.read_metadata)(stream)
        groups.add_settings("", _settings(file.properties, ""))
        channels = [channel for group in file.groups() for channel in group.channels()]
        starts = [_started(channel.properties) for channel in channels]
        first = min((start for start in starts if start is not None), default=None)
        for group in file.groups():
            groups.add_settings(group.name, _settings(group.properties, group.name))
        for channel, start in zip(channels, starts, strict=True):
            own = channel.properties
            interval, offset = (_number(own.get(f"wf_{x}")) for x in ("increment", "start_offset"))
            if start is not None and first is not None:
                offset += float((start - first) / np.timedelta64(1, "ns")) / 1e9
            column = RawColumn(
                channel.name,
                next((text for key in _UNITS if (text := str(own.get(key, "")).strip())), None),
                np.asarray(channel[:]) if values and len(channel) else np.empty(0),
                str(own.get("description", "")),
                f"{channel.group_name}/{channel.name}",
                Clock(offset, interval) if interval > 0 else None,
            )
            groups.add_column(channel.group_name, column)
        cut = bool(file.file_status.incomplete_final_segment)
    notes = {"file_incomplete": "the file ends before its last segment does"} if cut else {}
    return groups.as_file(path, "tdms")._replace(notes=notes)


def _settings(properties: Mapping[str, Any], path: str) -> list[Any]:
    kinds = (int, float, str)
    plain = {k: v if isinstance(v, kinds) else str(v) for k, v in properties.items()}
    return [s for key, value in plain.items() for s in settings_of(str(key), value, path)]


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) and np.isfinite(value) else 0.0


def _started(properties: Mapping[str, Any]) -> np.datetime64 | None:
    start = properties.get("wf_start_time")
    if isinstance(start, np.datetime64) and not np.isnat(start):
        return start.astype("datetime64[ns]")
    return None
