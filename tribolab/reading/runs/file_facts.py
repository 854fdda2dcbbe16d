"""Summary of how one raw file and its second log were interpreted."""

from __future__ import annotations

from pathlib import Path
from typing import TypedDict

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.aliases import PathLike
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError
from tribolab.reading.dialect.find import Instrument, known_dialects, load_dialect, recognise
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.runs.logs import companion_name, companion_path
from tribolab.reading.runs.read_run import read_log, with_companion
from tribolab.reading.runs.row_counts import ROW_ATTRIBUTES, rows_in_words
from tribolab.reading.signals import Signals
from tribolab.reading.text.first_bytes import peek
from tribolab.units.quantities import QUANTITIES


class ColumnFacts(TypedDict):
    """Column of a quantity: label in the file, SI unit, minimum and maximum."""

    label: str
    unit: str
    minimum: float
    maximum: float


class FileFacts(TypedDict):
    """Summary of how a raw file was interpreted; see `file_facts`."""

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


class CompanionFacts(TypedDict, total=False):
    """Information on a companion log; see `describe_companion`."""

    missing: str
    refused: str
    instrument: str
    shift_s: float
    uncertainty_s: float
    source: str
    ways: dict[str, str]


def describe_companion(
    path: str | Path, instrument: str | Path | None = None, log: Signals | None = None
) -> CompanionFacts:
    """Return information on a raw file's companion log and the alignment of its clock.

    Parameters
    ----------
    path
        The main log.
    instrument
        As for `tribolab.read`.
    log
        Signals of the main log, if already read.

    Returns
    -------
    dict
        Empty if the instrument writes one log only. ``missing`` is the name of an absent companion,
        ``refused`` the reason why it or its clock cannot be used. Otherwise ``instrument``,
        ``shift_s``, ``uncertainty_s``, ``source`` ("estimated" or "none") and ``ways`` (result by
        name of the method).
    """
    try:
        dialect = _pairing(Path(path), instrument)
        if dialect is None:
            return {}
        other = companion_path(Path(path), dialect)
        if other is None or not other.exists():
            return {"missing": companion_name(Path(path), dialect)}
        log = read_log(path, instrument) if log is None else log
        attrs = with_companion(log, other, dialect).attrs
    except ReadError as error:
        return {"refused": error.message_for("terminal")}
    facts: CompanionFacts = {
        "instrument": attrs["companion_instrument"],
        "shift_s": float(attrs["clock_shift_s"]),
        "uncertainty_s": float(attrs["clock_shift_uncertainty_s"]),
        "source": attrs["clock_shift_source"],
        "ways": dict(attrs.get("clock_shift_ways", {})),
    }
    if not np.isfinite(facts["uncertainty_s"]):
        facts["refused"] = attrs.get(
            "clock_shift_refused", "the friction force does not follow the motion"
        )
    return facts


def has_companion(path: Path, instrument: str | Path | None = None) -> bool:
    """Whether the second log that belongs to a main log exists."""
    dialect = _pairing(path, instrument)
    other = None if dialect is None else companion_path(path, dialect)
    return other is not None and other.exists()


def _pairing(path: Path, instrument: str | Path | None) -> Dialect | None:
    """Return the dialect of a file if it is a main log with a second log; else None."""
    if instrument is None and peek(path).format == "netcdf":
        return None
    dialect = load_dialect(instrument) if instrument else recognise(path)
    alone = dialect.pair is None or path.stem.endswith(dialect.pair.other)
    return None if alone else dialect
