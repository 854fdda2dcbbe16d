"""What the table of runs says of a run at a glance: a word for its state, why, and how it looks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tribolab.qc.run_checks import RUN_CHECKS

_STEADINESS = RUN_CHECKS["steadiness"].limits
# A number at or above these is marked in the table of runs. Drift is judged as the check on
# steadiness does; friction of soft contacts scatters by 2 to 10 % around a segment's mean.
THRESHOLDS: dict[str, dict[str, float]] = {
    "noise": {"suspect": 0.10, "fail": 0.50},
    "drift": {key: _STEADINESS[key].value for key in ("suspect", "fail")},
}
# Chance below which a trend counts as one, again as that check has it.
SURE = _STEADINESS["chance"].value
_GRAVE = ("error", "fail", "suspect")


def judge(kind: str, value: float | None) -> str:
    """Return ``"fail"``, ``"suspect"`` or nothing for a number of a kind.

    Examples
    --------
    >>> judge("noise", 0.2), judge("drift", 0.01), judge("noise", None)
    ('suspect', '', '')
    """
    limits = THRESHOLDS[kind]
    if value is None or value < limits["suspect"]:
        return ""
    return "fail" if value >= limits["fail"] else "suspect"


def is_bad(run: Mapping[str, Any]) -> bool:
    """Return whether nothing of a run went into the curves: it failed, or its checks did."""
    return run["status"] != "done" or run["quality"] in ("fail", "error")


def status_word(run: Mapping[str, Any]) -> str:
    """Return one word: failed, error, fail, suspect or done.

    Examples
    --------
    >>> status_word({"status": "done", "quality": "pass"})
    'done'
    """
    if run["status"] != "done":
        return "failed"
    return run["quality"] if run["quality"] in _GRAVE else "done"


def why(run: Mapping[str, Any]) -> str:
    """Return why a run stands as it does: the error, or the gravest objection of its checks.

    Examples
    --------
    >>> row = {"check": "spikes", "status": "suspect", "message": "3 samples stand out"}
    >>> why({"status": "done", "quality": "suspect", "checks": [row, row]})
    'spikes: 3 samples stand out (and 1 more)'
    """
    if run["status"] != "done":
        return str(run["reason"] or run["error"])
    grave = [row for row in run["checks"] if row["status"] in _GRAVE]
    if not grave:
        return ""
    first = min(grave, key=lambda row: _GRAVE.index(row["status"]))
    more = f" (and {len(grave) - 1} more)" if len(grave) > 1 else ""
    return f"{first['check']}: {first['message']}{more}"
