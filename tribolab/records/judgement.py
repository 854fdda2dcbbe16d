"""Status of a run in the table of runs: word, reason and colour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tribolab.qc.run.checks import RUN_CHECKS
from tribolab.records.parts import BAD
from tribolab.records.verdict import contradicts_repeats


@dataclass(frozen=True)
class Limits:
    """Limits above which a number is suspect, or fails."""

    suspect: float
    fail: float


_STEADINESS = {name: limit.value for name, limit in RUN_CHECKS["steadiness"].limits.items()}
# Numbers above these are marked in the table of runs. Drift is judged by the limits of the check
# on steadiness; friction of soft contacts scatters by 2 to 10 % around a segment's mean.
THRESHOLDS = {
    "noise": Limits(0.10, 0.50),
    "drift": Limits(_STEADINESS["suspect"], _STEADINESS["fail"]),
}
_GRAVE = ("error", "fail", "suspect")
_BY_HAND = {"rejected": "reject", "accepted": "accept"}  # verdict of a person, and the action


def judge(kind: str, value: float | None) -> str:
    """Return the status of a number of a kind: ``"fail"``, ``"suspect"`` or empty.

    Examples
    --------
    >>> judge("noise", 0.2), judge("drift", 0.01), judge("noise", None)
    ('suspect', '', '')
    """
    limits = THRESHOLDS[kind]
    if value is None or value < limits.suspect:
        return ""
    return "fail" if value >= limits.fail else "suspect"


def is_bad(run: Mapping[str, Any]) -> bool:
    """Return whether a run is excluded from the curves: failed, or rejected."""
    return run["status"] != "done" or run["quality"] in BAD


def is_odd(run: Mapping[str, Any]) -> bool:
    """Return whether a run contradicts its repeats and no person has decided on it."""
    return contradicts_repeats(run["checks"])


def status_word(run: Mapping[str, Any]) -> str:
    """Return the status: failed, rejected, rejected by hand, kept, accepted, suspect or done.

    A failed run could not be read; the numbers of a rejected run are not used.

    Examples
    --------
    >>> [status_word({"status": "done", "quality": word}) for word in ("pass", "fail", "rejected")]
    ['done', 'rejected', 'rejected by hand']
    """
    if run["status"] != "done":
        return "failed"
    if run["quality"] == "rejected":
        return "rejected by hand"
    if is_bad(run):
        return "rejected"
    if run.get("kept"):
        return "kept"
    return run["quality"] if run["quality"] in (*_GRAVE, *_BY_HAND) else "done"


def check_words(name: str) -> str:
    """Name of a check and its variable, in words.

    Examples
    --------
    >>> check_words("friction_sign friction_force"), check_words("hum"), check_words("surface S_1")
    ('friction sign (friction force)', 'hum', 'surface S_1')
    """
    check, _, of = name.partition(" ")
    if check not in RUN_CHECKS:
        return name
    return check.replace("_", " ") + (f" ({of.replace('_', ' ')})" if of else "")


_CAUSE = "saturation"


def why(run: Mapping[str, Any]) -> str:
    """Return the reason for the status of a run: error, decision, or worst objection of its checks.

    Examples
    --------
    >>> row = {"check": "spikes", "status": "suspect", "message": "3 samples stand out"}
    >>> why({"status": "done", "quality": "suspect", "checks": [row, row]})
    'spikes: 3 samples stand out (and 1 more)'
    """
    if run["status"] != "done":
        return str(run["reason"] or run["error"])
    if run.get("kept"):
        return str(run["kept"])
    if run["quality"] in _BY_HAND:
        return _decision_text(run, _BY_HAND[run["quality"]])
    grave = [row for row in run["checks"] if row["status"] in _GRAVE and not row.get("decision")]
    if not grave:
        return ""
    # saturation first, as it triggers other checks; then repeats, as the run may have any fault
    order = [_CAUSE, *(row["check"] for row in grave if row["check"] == "repeats")]
    order += [row["check"] for row in grave]
    first = min(grave, key=lambda row: (_GRAVE.index(row["status"]), order.index(row["check"])))
    more = f" (and {len(grave) - 1} more)" if len(grave) > 1 else ""
    return f"{check_words(first['check'])}: {first['message']}{more}"


def _decision_text(run: Mapping[str, Any], action: str) -> str:
    """Return who rejected or accepted a run, against which objections, and why."""
    texts = [
        f"{run['quality']} by {row['author']}: {row['reason']}"
        for row in run["decisions"]
        if row["action"] == action
    ]
    spite = [row["check"] for row in run["checks"] if row["decision"].startswith("accepted")]
    end = f" (in spite of {', '.join(dict.fromkeys(spite))})" if spite else ""
    return "; ".join(dict.fromkeys(texts)) + end
