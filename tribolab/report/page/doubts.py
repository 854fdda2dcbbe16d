"""What is doubtful of a campaign, each doubt with what removes it: the gravest first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.records.judgement import check_words, is_bad
from tribolab.records.notice_words import STEPS_DIFFER, TRENDS
from tribolab.report.live.curves import system_name
from tribolab.report.plain import listed
from tribolab.words import force_text, many

_GRAVE = ("error", "fail", "suspect")
_MAX_NAMED = 2  # runs named in a doubt
_UNCALIBRATED = "statistical only"


class Doubt(NamedTuple):
    """What is doubtful and what to do; `level` is "fail", "suspect" or "note".

    `runs` names those concerned, `link` leads to what shows it.
    """

    level: str
    runs: str
    text: str
    cure: str
    link: str


def doubts(document: Mapping[str, Any]) -> list[Doubt]:
    """Return the doubts about a campaign, those that agree but for the run as one.

    Parameters
    ----------
    document
        As in report.json, of the runs at least the brief part.
    """
    found = [*_of_findings(document), *_missing_curves(document)]
    found.sort(key=lambda doubt: _GRAVE.index(doubt.level))
    along = [row for row in document["findings"] if row["message"].startswith(_ALONG)]
    if along:
        who = _names([row["run"] for row in along])
        text = f"{along[0]['message']}" if len(along) == 1 else "friction changes along the run"
        found.append(Doubt("suspect", who, text, "", "#findings"))
    found += _notes(document)
    return found


_ALONG = (*TRENDS, STEPS_DIFFER)


def _notes(document: Mapping[str, Any]) -> Iterable[Doubt]:
    if any(_UNCALIBRATED in curve["uncertainty_says"] for curve in document["curves"]):
        text = "± is statistical only: no calibration uncertainty was given"
        yield Doubt("note", "", text, "State it in [uncertainty].", "#uncertainty")
    for row in document["findings"]:
        if row["where"] == "campaign":
            yield Doubt("note", "", row["message"].rstrip("."), "", "")


def _of_findings(document: Mapping[str, Any]) -> Iterable[Doubt]:
    runs = {run["name"]: run for run in document["runs"]}
    grouped: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for row in document["findings"]:
        if row["severity"] in _GRAVE and not row["message"].startswith(_ALONG):
            key = row["severity"], row["where"] if row["where"] != "run" else row["message"]
            grouped.setdefault(key, []).append(row)
    for (severity, _), rows in grouped.items():
        names = [name for row in rows for name in row["run"].split("; ") if name]
        names = list(dict.fromkeys(names))
        row = rows[0]
        said = _said(row, runs.get(names[0])) if names else ""
        text, cure = (said or row["message"]), ""
        if said:
            cure = row["message"][len(said) :].lstrip(". ")
        if severity != "suspect" and names and all(is_bad(runs[n]) for n in names if n in runs):
            text += ", left out"
        if not said and row["where"] != "run":
            text = f"{check_words(row['where'])}: {text}"
        link = f"run {names[0]}" if len(names) == 1 else "#findings"
        yield Doubt(severity, _names(names, len(runs)), text.rstrip("."), cure, link)


def _said(row: Mapping[str, Any], run: Mapping[str, Any] | None) -> str:
    """Return the message of the check behind a finding, which the cure follows."""
    checks = run["checks"] if run is not None else ()
    known = [check["message"] for check in checks if row["message"].startswith(check["message"])]
    return max(known, key=len, default="")


def _names(names: Sequence[str], of: int = 0) -> str:
    names = list(dict.fromkeys(names))
    if len(names) == of > 1:
        return "all runs"
    return listed(names) if len(names) <= _MAX_NAMED else many(len(names), "run")


def _missing_curves(document: Mapping[str, Any]) -> Iterable[Doubt]:
    """Give the conditions that were measured and have no curve, and why."""
    there = {
        (curve["surface"], curve["medium"], curve["nominal_normal_force_N"])
        for curve in document["curves"]
    }
    in_curves = {name for curve in document["curves"] for name in curve["runs"]}
    conditions: dict[tuple[str, str, float | None], list[Mapping[str, Any]]] = {}
    for run in document["runs"]:
        key = run["surface"], run["medium"], run["nominal_normal_force_N"]
        several = key[2] is None and run["name"] in in_curves
        if (key[0] or key[1]) and key not in there and not several:
            conditions.setdefault(key, []).append(run)
    for (surface, medium, load), runs in conditions.items():
        condition = f"{system_name(surface, medium)}, {force_text(load)}"
        if reason := _why(runs):
            yield Doubt("suspect", condition, f"no curve, {reason}", "", "#runs")


def _why(runs: Sequence[Mapping[str, Any]]) -> str:
    """Say why runs of one condition make no curve; "" if they have no segment to begin with."""
    failed = [run for run in runs if run["status"] != "done"]
    rejected = [run for run in runs if run["status"] == "done" and is_bad(run)]
    which = {1: "its only run", 2: "both runs"}.get(len(runs), f"all {len(runs)} runs")
    verb = "was" if len(runs) == 1 else "were"
    if all(run["quality"] == "rejected" for run in rejected) and len(rejected) == len(runs):
        return f"{which} {verb} rejected by hand"
    if len(rejected) == len(runs):
        return f"{which} {verb} rejected"
    if len(failed) == len(runs):
        return f"{which} could not be read"
    if len(failed) + len(rejected) == len(runs):
        return f"{len(failed)} could not be read and {len(rejected)} rejected"
    return ""
