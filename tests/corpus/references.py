"""Numbers of real files that somebody else computed, and what reading makes of them.

They stand in ``references.jsonl`` and come from the README of the reference material: of a signal
of a file the mean, the standard deviation, the median, the first or last value, or the count.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from corpus.store import HERE, SHARED
from tribolab.core.errors import TribolabError
from tribolab.reading.run_files import read as read_run
from tribolab.reading.scan_files import read_scans
from tribolab.rubber.modulus import read_modulus

RIGHT, WRONG, NOT_READ = "right", "WRONG", "not read"
_TAKE: Mapping[str, Callable[[np.ndarray], float]] = {
    "mean": lambda values: float(np.nanmean(values)),
    "trimmed mean": lambda values: float(
        np.nanmean(values[len(values) // 10 : -len(values) // 10])
    ),
    "sd": lambda values: float(np.nanstd(values, ddof=1)),
    "median": lambda values: float(np.nanmedian(values)),
    "first": lambda values: float(values[0]),
    "last": lambda values: float(values[-1]),
    "count": lambda values: float(values.size),
}


def judge_references() -> list[tuple[str, str]]:
    """Return for each number whether it is right, and what was found."""
    lines = (HERE / "references.jsonl").read_text(encoding="utf-8").splitlines()
    return [_judged(json.loads(line)) for line in lines]


def _judged(told: Mapping[str, Any]) -> tuple[str, str]:
    about = f"{told['file']}: {told['take']} of {told['signal']} {told['value']}"
    try:
        values = _signal(SHARED / told["file"], told["signal"])
    except TribolabError as error:
        return NOT_READ, f"{about}: {str(error).splitlines()[0][:120]}"
    except KeyError:
        return NOT_READ, f"{about}: no such signal"
    found = _TAKE[told["take"]](values.ravel())
    good = abs(found - told["value"]) <= told["relative"] * abs(told["value"])
    return RIGHT if good else WRONG, f"{about}: {found:.6g}"


def _signal(path: Path, name: str) -> np.ndarray:
    if name == "height":
        return read_scans(path)[name].values
    if name in ("angular_frequency", "storage", "loss"):
        return np.asarray(getattr(read_modulus(path), name))
    return read_run(path)[name].values
