"""Signals of a run from an earlier data file, which avoids reading the raw files.

Reading the raw files of a run and aligning its two clocks takes as long as the rest of the
analysis. A data file contains the same signals with the results of the checks. It also records the
changes of the analysis, so that they can be undone, and a checksum of everything that affects
reading.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.campaign.runs.sources import sources_of_run
from tribolab.campaign.store.catalogue import fingerprint_of
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError
from tribolab.core.provenance import as_text, sha256_of
from tribolab.reading.dialect.zero_reading import parse_zero

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.settings.plan import PlannedRun
    from tribolab.core.untyped import Json
    from tribolab.records.parts import Source

READING = "reading"  # attribute of a run in a data file: checksum, and changes of the analysis


class Earlier(NamedTuple):
    """Earlier data file, and the checksum that its signals must have."""

    file: Path
    mark: str


def mark_of(run: PlannedRun, sources: Sequence[Source]) -> str:
    """Return the checksum of all inputs of a run's signals; "" if a file is unreadable."""
    sums = [checksum for _, checksum, _ in sources]
    if not all(sums):
        return ""
    names = [as_text(file.name) for file in run.files]
    return fingerprint_of(sha256_of([run.reading_sha256, names, sums]))


def note_reading(run: PlannedRun, read: xr.Dataset, marked: xr.Dataset) -> None:
    """Record in the attributes of the analysed signals how to restore the signals as read.

    Parameters
    ----------
    run
        The planned run.
    read
        The signals as they were read (time).
    marked
        The same with the changes of the analysis.
    """
    attrs = read.attrs
    if not _has_only_its_files(run, attrs):
        return
    mark = mark_of(run, sources_of_run(run, attrs))
    changed = {"attrs": _attribute_changes(attrs, marked.attrs)} | {
        "variables": {
            str(name): _attribute_changes(variable.attrs, marked.variables[name].attrs)
            for name, variable in read.variables.items()
        }
    }
    if mark and _is_plain(changed):
        marked.attrs[READING] = {"mark": mark} | changed


def _has_only_its_files(run: PlannedRun, attrs: Json) -> bool:
    """Whether only files of the run were read; a second log or a blank run may change."""
    alone = len(str(attrs.get("source", "")).split("; ")) == len(run.files)
    blank = any(
        parse_zero(str(text)).file for text in RunAttributes.from_attrs(attrs).zeros_read.values()
    )
    return alone and not blank and "companion_missing" not in attrs


def earlier_signals(earlier: Earlier) -> xr.Dataset | None:
    """Return the signals of a run from an earlier reading; None if unavailable.

    Parameters
    ----------
    earlier
        Earlier data file.

    Returns
    -------
    xarray.Dataset or None
        The same signals as from the raw files (time).
    """
    from tribolab.reading.netcdf.netcdf import read_netcdf  # imported late for a quick start

    try:
        marked = read_netcdf(earlier.file, "run")
    except ReadError:  # missing or damaged: the raw files are read
        return None
    noted = marked.attrs.get(READING)
    if not earlier.mark or not isinstance(noted, dict) or noted.get("mark") != earlier.mark:
        return None
    signals = marked[[name for name in noted["variables"] if name not in marked.coords]]
    signals.attrs = _earlier_attrs(marked.attrs, noted["attrs"])
    for name, changed in noted["variables"].items():
        signals.variables[name].attrs = _earlier_attrs(marked.variables[name].attrs, changed)
    return signals


def _attribute_changes(before: Mapping[object, object], after: Mapping[object, object]) -> Json:
    """Return the changes of attributes, from which the earlier ones can be restored."""
    was = {str(k): v for k, v in before.items() if k not in after or after[k] is not v}
    return {"was": was, "new": [str(k) for k in after if k not in before]}


def _earlier_attrs(after: Mapping[object, object], changed: Json) -> Json:
    kept = {str(k): v for k, v in after.items() if k not in changed["new"] and k != READING}
    return kept | changed["was"]


def _is_plain(changed: Json) -> bool:
    """Whether a value is unchanged after writing it as JSON and reading it back."""
    try:
        return bool(json.loads(json.dumps(changed)) == changed)
    except (TypeError, ValueError):
        return False
