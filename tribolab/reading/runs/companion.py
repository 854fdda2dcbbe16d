"""Information on a run's second log: whether it exists, and how its clock was aligned."""

from __future__ import annotations

from pathlib import Path
from typing import TypedDict

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.find import load_dialect, recognise
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.runs.logs import companion_name, companion_path
from tribolab.reading.runs.read_run import read_log, with_companion
from tribolab.reading.signals import Signals
from tribolab.reading.text.first_bytes import peek


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
    """Return the dialect of a main log with a second log."""
    if instrument is None and peek(path).format == "netcdf":
        return None
    dialect = load_dialect(instrument) if instrument else recognise(path)
    alone = dialect.pair is None or path.stem.endswith(dialect.pair.other)
    return None if alone else dialect
