"""Summary of the interpretation of one raw file."""

from __future__ import annotations

from typing import TypedDict

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.aliases import PathLike
from tribolab.core.attributes import RunAttributes
from tribolab.reading.dialect.find import Instrument, known_dialects, load_dialect
from tribolab.reading.runs.row_counts import ROW_ATTRIBUTES, rows_in_words
from tribolab.reading.signals import Signals
from tribolab.units.quantities import QUANTITIES


class ColumnFacts(TypedDict):
    """Label of a quantity, and its range in SI."""

    label: str
    unit: str
    minimum: float
    maximum: float


class FileFacts(TypedDict):
    """Interpretation of a raw file; see `file_facts`."""

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


def file_facts(log: Signals, path: PathLike, instrument: Instrument | None = None) -> FileFacts:
    """Return a summary of how one raw file was interpreted.

    Parameters
    ----------
    log
        Signals of this file alone.
    path, instrument
        The file, and the instrument if it was stated.

    Returns
    -------
    dict
        ``file``, ``instrument``, ``title``, ``columns`` (quantity -> label, unit, minimum and
        maximum in SI), ``not_used``, ``rows``, ``duration_s``, ``interval_s`` (median),
        ``longest_interval_s``, ``steps``, ``left_out`` (rows left out, with the reason; empty
        without any) and ``metadata``.
    """
    time, signals, attrs = log
    gaps = np.diff(time)
    about = RunAttributes.from_attrs(attrs)
    name, unused = about.instrument, about.columns_not_used
    columns: dict[str, ColumnFacts] = {
        name: {
            "label": about.columns_used.get(name, ""),
            "unit": QUANTITIES[name].unit if name in QUANTITIES else "",
            "minimum": float(np.fmin.reduce(values.ravel())),
            "maximum": float(np.fmax.reduce(values.ravel())),
        }
        for name, values in signals.items()
        if values.dtype.kind in "fiu"
    }
    known = known_dialects()
    title = load_dialect(instrument or name).title if instrument or name in known else ""
    known_attrs = {"source", "source_sha256", "tribolab_version", "history", "Conventions"}
    known_attrs |= {"columns_not_used", "columns_used", "instrument", *ROW_ATTRIBUTES}
    return {
        "file": str(path),
        "instrument": name,
        "title": title,
        "columns": columns,
        "not_used": unused.split("; ") if unused else [],
        "rows": len(time),
        "are_points": about.rows_are == "points",
        "duration_s": float(time[-1]) if len(time) else 0.0,
        "interval_s": float(median(gaps)) if len(gaps) else None,
        "longest_interval_s": float(gaps.max()) if len(gaps) else None,
        "steps": int(np.unique(signals["step"]).size) if "step" in signals else None,
        "left_out": rows_in_words(attrs),
        "metadata": {k: v for k, v in attrs.items() if k not in known_attrs},
    }
