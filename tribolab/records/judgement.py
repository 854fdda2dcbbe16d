"""What the table of runs says of a run at a glance: a word for its state, why, and how it looks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribolab.friction.coefficient.steadiness import undecided
from tribolab.qc.run.checks import RUN_CHECKS
from tribolab.records.parts import BAD
from tribolab.words import many, percent


@dataclass(frozen=True)
class Limits:
    """From where on a number is suspect, and from where on it is beyond the limit."""

    suspect: float
    fail: float


_STEADINESS = {name: limit.value for name, limit in RUN_CHECKS["steadiness"].limits.items()}
# A number at or above these is marked in the table of runs. Drift is judged as the check on
# steadiness does; friction of soft contacts scatters by 2 to 10 % around a segment's mean.
THRESHOLDS = {
    "noise": Limits(0.10, 0.50),
    "drift": Limits(_STEADINESS["suspect"], _STEADINESS["fail"]),
}
# Chance below which a trend counts as one, again as that check has it.
SURE = _STEADINESS["chance"]
_GRAVE = ("error", "fail", "suspect")
_BY_HAND = {"rejected": "reject", "accepted": "accept"}  # a person's verdict, and the action


def judge(kind: str, value: float | None) -> str:
    """Return ``"fail"``, ``"suspect"`` or nothing for a number of a kind.

    Examples
    --------
    >>> judge("noise", 0.2), judge("drift", 0.01), judge("noise", None)
    ('suspect', '', '')
    """
    limits = THRESHOLDS[kind]
    if value is None or value < limits.suspect:
        return ""
    return "fail" if value >= limits.fail else "suspect"


def not_decided(change: np.ndarray, chance: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Return where there may be a trend or none, as the check on steadiness has it."""
    return undecided(change, chance, samples, _STEADINESS)


def trend_texts(rows: Sequence[Mapping[str, Any]], quantity: str) -> list[tuple[float, str]]:
    """Return the trend of each segment as a number to sort by and a text.

    Parameters
    ----------
    rows
        The segments of a run, as in report.json.
    quantity
        What the run is told by: a friction coefficient, else a force.

    Examples
    --------
    >>> few = {"trend_change": -0.16, "trend_p_value": 0.36, "effective_samples": 2.8}
    >>> many = {"trend_change": 8e-4, "trend_p_value": 1e-9, "effective_samples": 300}
    >>> rows = [{"friction_coefficient": 0.8} | row for row in (few, many)]
    >>> [text for _, text in trend_texts(rows, "friction_coefficient")]
    ['−20 %, not decided (p = 0.36)', '+0.1 %, significant']
    """
    trends = _trends(rows, quantity)
    if trends is None:
        return [(0.0, "–") for _ in rows]
    return [_trend_text(*trend) for trend in zip(*trends, strict=True)]


def undecided_trends(runs: Iterable[tuple[str, Sequence[Mapping[str, Any]], str]]) -> str:
    """Return in how many segments a large trend is undecided, and the largest, or "".

    Parameters
    ----------
    runs
        Name, segments and quantity of each run, as for `trend_texts`.

    Examples
    --------
    >>> row = {"friction_coefficient": 0.8, "trend_p_value": 0.36, "effective_samples": 2.8}
    >>> short = [row | {"trend_change": change} for change in (-0.16, 0.0)]
    >>> undecided_trends([("a", short, "friction_coefficient")])
    'Trend undecided in 1 of 2 segments, at most −20 % along one (run a): too short a record to \
tell drift from noise'
    """
    number = total = 0
    largest, where = 0.0, ""
    for name, rows, quantity in runs:
        total += len(rows)
        if (trends := _trends(rows, quantity)) is None or not trends[2].any():
            continue
        change = trends[0][trends[2]]
        number += change.size
        worst = float(change[np.argmax(np.abs(change))])
        if abs(worst) > abs(largest):
            largest, where = worst, name
    if not number:
        return ""
    size = f"{'+' if largest > 0 else ''}{percent(largest)}"
    return (
        f"Trend undecided in {number} of {many(total, 'segment')}, at most {size} along one "
        f"(run {where}): too short a record to tell drift from noise"
    )


def _trends(
    rows: Sequence[Mapping[str, Any]], quantity: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return change of the typical friction, p value, and where the trend is undecided."""

    def column(name: str) -> np.ndarray:
        return np.array([np.nan if (v := row.get(name)) is None else v for row in rows], float)

    change, key = column("trend_change"), "friction_coefficient"
    if quantity != key:
        key = f"{quantity}_N"
        change = column("force_trend_N_s") * (column("trimmed_stop_s") - column("trimmed_start_s"))
    value = np.abs(column(key))
    typical = value[np.isfinite(value)]
    if not (typical > 0).any():
        return None
    change, chance = change / typical.mean(), column("trend_p_value")
    return change, chance, not_decided(change, chance, column("effective_samples"))


def _trend_text(change: float, chance: float, is_open: bool) -> tuple[float, str]:
    if not np.isfinite(change):
        return 0.0, "–"
    size = f"{'+' if change > 0 else ''}{percent(float(change))}"
    if is_open:
        return float(change), f"{size}, not decided (p = {chance:.2g})"
    return float(change), f"{size}, {'significant' if chance < SURE else f'p = {chance:.2g}'}"


def is_bad(run: Mapping[str, Any]) -> bool:
    """Return whether nothing of a run went into the curves: failed, or rejected by whomever."""
    return run["status"] != "done" or run["quality"] in BAD


def status_word(run: Mapping[str, Any]) -> str:
    """Return failed, rejected, rejected by hand, kept, accepted, suspect or done.

    One that failed could not be read; one that its checks rejected has numbers that count nowhere.

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
    """Return a check, and what it looked at, as they are called in words.

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
    """Return why a run stands as it does: error, decision, or gravest objection of its checks.

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
        return _decided(run, _BY_HAND[run["quality"]])
    grave = [row for row in run["checks"] if row["status"] in _GRAVE and not row.get("decision")]
    if not grave:
        return ""
    # what a clipped signal does to other checks is not told before the clipping
    first = min(grave, key=lambda row: (_GRAVE.index(row["status"]), row["check"] != _CAUSE))
    more = f" (and {len(grave) - 1} more)" if len(grave) > 1 else ""
    return f"{check_words(first['check'])}: {first['message']}{more}"


def _decided(run: Mapping[str, Any], action: str) -> str:
    """Say who rejected or accepted a run, in spite of what, and why."""
    said = [
        f"{run['quality']} by {row['author']}: {row['reason']}"
        for row in run["decisions"]
        if row["action"] == action
    ]
    spite = [row["check"] for row in run["checks"] if row["decision"].startswith("accepted")]
    end = f" (in spite of {', '.join(dict.fromkeys(spite))})" if spite else ""
    return "; ".join(dict.fromkeys(said)) + end
