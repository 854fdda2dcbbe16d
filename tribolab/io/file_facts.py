"""What was understood of one raw file, for whoever wants to know before an analysis."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
import xarray as xr

from tribolab.aliases import PathLike
from tribolab.io.dialects.find import Instrument, known_dialects, load_dialect
from tribolab.io.row_counts import ROW_ATTRIBUTES, rows_in_words
from tribolab.medians import median


class ColumnFacts(TypedDict):
    """What a quantity was called, and between which values it lies, in SI."""

    label: str
    unit: str
    minimum: float
    maximum: float


class FileFacts(TypedDict):
    """What was understood of a raw file; see `file_facts`."""

    file: str
    instrument: str
    title: str
    columns: dict[str, ColumnFacts]
    not_used: list[str]
    rows: int
    are_points: bool
    duration_s: float
    interval_s: float | None
    longest_interval_s: float | None
    steps: int | None
    left_out: str
    metadata: dict[str, object]


def file_facts(run: xr.Dataset, path: PathLike, instrument: Instrument | None = None) -> FileFacts:
    """Say what was understood of one raw file.

    Parameters
    ----------
    run
        The run as read from it alone (time).
    path, instrument
        What it was read from, and as which instrument's if that was said.

    Returns
    -------
    dict
        ``file``, ``instrument``, ``title``, ``columns`` (quantity -> label, unit, minimum and
        maximum in SI), ``not_used``, ``rows``, ``duration_s``, ``interval_s`` (median),
        ``longest_interval_s``, ``steps``, ``left_out`` (rows of the file that are not in the run,
        and why; empty if all are) and ``metadata``.
    """
    time = run["time"].to_numpy()
    gaps = np.diff(time)
    labels = run.attrs.get("columns_used", {})
    columns: dict[str, ColumnFacts] = {
        str(name): {
            "label": labels.get(str(name), ""),
            "unit": run[name].attrs.get("units", ""),
            "minimum": float(run[name].min()),
            "maximum": float(run[name].max()),
        }
        for name in run.data_vars
        if run[name].dtype.kind in "fiu"
    }
    name = str(run.attrs.get("instrument", ""))
    known = known_dialects()
    title = load_dialect(instrument or name).title if instrument or name in known else ""
    known_attrs = {"source", "source_sha256", "tribolab_version", "history", "Conventions"}
    known_attrs |= {"columns_not_used", "columns_used", "instrument", *ROW_ATTRIBUTES}
    unused = str(run.attrs.get("columns_not_used", ""))
    return {
        "file": str(path),
        "instrument": name,
        "title": title,
        "columns": columns,
        "not_used": unused.split("; ") if unused else [],
        "rows": len(time),
        "are_points": run.attrs.get("rows_are") == "points",
        "duration_s": float(time[-1]) if len(time) else 0.0,
        "interval_s": float(median(gaps)) if len(gaps) else None,
        "longest_interval_s": float(gaps.max()) if len(gaps) else None,
        "steps": int(np.unique(run["step"]).size) if "step" in run else None,
        "left_out": rows_in_words(run.attrs),
        "metadata": {k: v for k, v in run.attrs.items() if k not in known_attrs},
    }
