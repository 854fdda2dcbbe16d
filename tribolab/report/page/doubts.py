"""Doubts about a campaign for the first screen of the page, each with its remedy."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.core.wording import force_text, many
from tribolab.records.judgement import check_words, is_bad, is_odd, why
from tribolab.records.models.model_words import is_described
from tribolab.records.verdict import furthest_repeat, uncertain_mean, uncertain_words
from tribolab.report.page_figures.curves import system_name
from tribolab.report.plain import listed

_GRAVE = ("error", "fail", "suspect")
_MAX_NAMED, _MAX_LISTED = 2, 6  # most runs that get a doubt each; most runs that one doubt names
_REPEATS = "repeats"  # name of the check that compares repeats
_COMPARE = "Compare its trace with those of its repeats."
_COMPARE_ALL = (
    "They are still included in the means. Compare their traces with those of their repeats."
)
_UNCALIBRATED = "statistical only"


class Doubt(NamedTuple):
    """A doubt and its remedy (`cure`); `level` is "fail", "suspect" or "note".

    `runs` names the runs concerned; `link` leads to their details on the page.
    """

    level: str
    runs: str
    text: str
    cure: str
    link: str


def doubts(document: Mapping[str, Any]) -> list[Doubt]:
    """Return the doubts about a campaign: excluded runs, odd repeats, other findings, notes.

    Parameters
    ----------
    document
        Content of report.json; short entries of the runs suffice.
    """
    found = [*_of_findings(document), *_missing_curves(document)]
    found += _uncertain_means(document)
    found.sort(key=lambda doubt: _GRAVE.index(doubt.level))
    return [*_left_out(document["runs"]), *_odd_runs(document["runs"]), *found, *_notes(document)]


def _odd_runs(runs: Sequence[Mapping[str, Any]]) -> Iterable[Doubt]:
    """Yield doubts about runs that contradict their repeats."""
    odd = [
        (run["name"], row["message"])
        for run in runs
        for row in run["checks"]
        if row["check"] == _REPEATS and not row["decision"] and not is_bad(run)
    ]
    if len(odd) > _MAX_NAMED:
        names = ", ".join(name for name, _ in odd[:_MAX_LISTED])
        more = f" and {len(odd) - _MAX_LISTED} more" if len(odd) > _MAX_LISTED else ""
        yield Doubt(
            "suspect", many(len(odd), "odd repeat"), f"{names}{more}", _COMPARE_ALL, "#runs"
        )
        return
    for name, message in odd:
        yield Doubt("suspect", name, message.rstrip("."), _COMPARE, f"run {name}")


def _left_out(runs: Sequence[Mapping[str, Any]]) -> Iterable[Doubt]:
    """Yield doubts that name the runs excluded from all results, with the main reason."""
    bad = [run for run in runs if is_bad(run)]
    for run in bad if len(bad) <= _MAX_NAMED else ():
        yield Doubt("fail", run["name"], f"left out, {why(run)}", "", f"run {run['name']}")
    if len(bad) > _MAX_NAMED:
        named = [f"{r['name']} ({re.split('[:;]', why(r))[0]})" for r in bad[:_MAX_LISTED]]
        more = f" and {len(bad) - _MAX_LISTED} more" if len(bad) > _MAX_LISTED else ""
        yield Doubt(
            "fail", many(len(bad), "run"), f"left out: {', '.join(named)}{more}", "", "#runs"
        )


def _uncertain_means(document: Mapping[str, Any]) -> Iterable[Doubt]:
    """Yield a doubt that names the conditions whose mean is uncertain because repeats scatter."""
    levels = {run["name"]: _level(run) for run in document["runs"]}
    odd = {run["name"] for run in document["runs"] if is_odd(run)}
    wide = [
        (
            share,
            f"{system_name(curve['surface'], curve['medium'], curve['runs'])}, {load}"
            + furthest_repeat({name: levels[name] for name in curve["runs"]}, odd),
        )
        for curve in document["curves"]
        if (share := uncertain_mean(curve["points"])) is not None
        and (load := force_text(curve["nominal_normal_force_N"]))
    ]
    if wide:
        cure = "Find the faulty run, or repeat the measurement."
        yield Doubt("suspect", "", uncertain_words(wide), cure, "#runs")


def _level(run: Mapping[str, Any]) -> float | None:
    """Return the steady friction of a run (if at one speed), else its first highlighted value."""
    steady = [row["steady_friction_coefficient"] for row in run.get("running_in", ())]
    highlights = [found["value"] for found in run.get("highlights", ())]
    return next(
        (level for level in (steady if len(steady) == 1 else []) + highlights if level), None
    )


def _notes(document: Mapping[str, Any]) -> Iterable[Doubt]:
    if any(_UNCALIBRATED in curve["uncertainty_says"] for curve in document["curves"]):
        text = "± is statistical only: no calibration uncertainty was given"
        yield Doubt(
            "note", "", text, "Add it under [uncertainty] in campaign.toml.", "#uncertainty"
        )
    fits = [model for model in document.get("models", ()) if model["fit"]]
    failed = [model for model in fits if not is_described(str(model["fit"]["judgement"]))]
    if failed:
        curves = {curve["name"]: curve for curve in document["curves"]}
        systems = (curves[model["curve"]] for model in failed)
        named = dict.fromkeys(system_name(curve["surface"], curve["medium"]) for curve in systems)
        text = f"the model does not describe {len(failed)} of {many(len(fits), 'curve')}"
        yield Doubt("note", "", f"{text} ({'; '.join(named)})", "", "#model")
    for row in document["findings"]:
        if row["where"] == "campaign":
            yield Doubt("note", "", row["message"].rstrip("."), "", "")


def _of_findings(document: Mapping[str, Any]) -> Iterable[Doubt]:
    runs = {run["name"]: run for run in document["runs"]}
    bad = {name for name, run in runs.items() if is_bad(run)}
    grouped: dict[tuple[str, str], list[tuple[list[str], str]]] = {}
    for row in document["findings"]:
        names = [name for name in row["run"].split("; ") if name]
        left_out = bool(names) and bad.issuperset(names)
        if row["severity"] not in _GRAVE or left_out or row["where"] == _REPEATS:
            continue
        grouped.setdefault((row["severity"], row["where"]), []).append((names, row["message"]))
    for (severity, where), rows in grouped.items():
        names = list(dict.fromkeys(name for members, _ in rows for name in members))
        message = rows[0][1]
        heading = _check_message(message, runs.get(names[0])) if names else ""
        cure = message[len(heading) :].lstrip(". ") if heading else ""
        text = heading or (message if where == "run" else f"{check_words(where)}: {message}")
        link = f"run {names[0]}" if len(names) == 1 else "#findings"
        yield Doubt(severity, _names(names, len(runs)), text.rstrip("."), cure, link)


def _check_message(message: str, run: Mapping[str, Any] | None) -> str:
    """Return the longest check message with which a finding begins; "" if there is none."""
    checks = run["checks"] if run is not None else ()
    known = [check["message"] for check in checks if message.startswith(check["message"])]
    return max(known, key=len, default="")


def _names(names: Sequence[str], of: int) -> str:
    if len(names) == of > 1:
        return "all runs"
    if len(names) <= _MAX_NAMED:
        return listed(names)
    return f"{many(len(names), 'run')}, e.g. {names[0]}"


def _missing_curves(document: Mapping[str, Any]) -> Iterable[Doubt]:
    """Yield doubts about conditions that were measured but have no curve, with the reason."""
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
        if reason := _missing_reason(runs):
            yield Doubt("suspect", condition, f"no curve, {reason}", "", "#runs")


def _missing_reason(runs: Sequence[Mapping[str, Any]]) -> str:
    """Return why the runs of a condition give no curve; "" if some run was read and accepted."""
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
