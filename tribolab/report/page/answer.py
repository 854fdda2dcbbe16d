"""What a campaign found, in plain words: a card for each surface and medium."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tribolab.records.judgement import check_words, is_bad, status_word, why
from tribolab.report.live.curves import system_name
from tribolab.report.page.in_words import friction_in_words, model_in_words, sentence
from tribolab.words import force_text, load_text, many

_GRAVE = ("fail", "error", "suspect")
_MOST_NAMELESS = 6  # curves of neither surface nor medium that a card tells
_MOST_FINDINGS = 2  # on a card; all of them stand among the findings
_LONGEST = 160  # characters of a finding on a card


@dataclass(frozen=True)
class AtLoad:
    """What was found at one load [N]: sentences, each about one thing.

    `text` is what the switch of loads calls it, `title` says where the load is from, too.
    """

    load: float | None
    text: str
    title: str
    sentences: tuple[str, ...]


@dataclass(frozen=True)
class Card:
    """One surface in one medium: what was found at each load, what is missing, what to look at.

    `more` says how many curves are left out. `figure` is the address of its figure, "" where no
    curve is known; `thin` are the runs that its curves had to do without, each with what is said.
    """

    name: str
    surface: str
    medium: str
    figure: str
    at_loads: tuple[AtLoad, ...]
    more: str
    thin: tuple[tuple[str, str], ...]
    missing: tuple[str, ...]
    findings: tuple[tuple[str, str], ...]


def cards(document: Mapping[str, Any]) -> list[Card]:
    """Return the cards of a report, in the order in which its curves and runs stand.

    Parameters
    ----------
    document
        As in report.json, of the runs at least what is brief.
    """
    systems: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for curve in document["curves"]:
        systems.setdefault((curve["surface"], curve["medium"]), []).append(curve)
    figures = {key: f"card-{place}" for place, key in enumerate(systems, start=1)}
    for run in document["runs"]:
        if run["surface"] or run["medium"]:
            systems.setdefault((run["surface"], run["medium"]), [])
    return [
        _card(document, key, sorted(curves, key=_force), figures.get(key, ""))
        for key, curves in systems.items()
    ]


def _force(what: Mapping[str, Any]) -> float:
    return what["nominal_normal_force_N"] or 0.0


def _card(
    document: Mapping[str, Any],
    key: tuple[str, str],
    curves: Sequence[Mapping[str, Any]],
    figure: str,
) -> Card:
    surface, medium = key
    runs = [run for run in document["runs"] if (run["surface"], run["medium"]) == key]
    named = bool(surface or medium)  # else each run is a curve of its own
    thin = tuple(_thin(curves, runs)) if named else ()
    names = {run["name"] for run in runs} - {name for name, _ in thin}
    all_runs = list(dict.fromkeys(run for curve in curves for run in curve["runs"]))
    at_loads = [_at_load(document, curve) for curve in curves]
    more = 0 if named else len(at_loads) - _MOST_NAMELESS
    return Card(
        name=system_name(surface, medium, all_runs),
        surface=surface,
        medium=medium,
        figure=figure,
        at_loads=tuple(at_loads[:_MOST_NAMELESS] if more > 0 else at_loads),
        more=f"{many(more, 'more curve')}: see all points" if more > 0 else "",
        thin=thin,
        missing=tuple(_missing(system_name(surface, medium), curves, runs)) if named else (),
        findings=tuple(_findings(document["findings"], names)),
    )


def _at_load(document: Mapping[str, Any], curve: Mapping[str, Any]) -> AtLoad:
    load = curve["nominal_normal_force_N"]
    model = next((m for m in document.get("models", ()) if m["curve"] == curve["name"]), None)
    mode = next((m for m in document.get("sliding_mode", ()) if m["curve"] == curve["name"]), None)
    sentences = [friction_in_words(curve["points"])]
    if mode is not None:
        sentences.append(sentence(mode["text"]))
    if model is not None and model["fit"] is not None:
        sentences += model_in_words(model["fit"])
    elif model is not None and model["status"] != "skipped":
        sentences.append(sentence(f"no model: {model['reason'] or 'see the findings'}"))
    alone = "" if curve["surface"] or curve["medium"] else system_name("", "", curve["runs"])
    title = ", ".join(filter(None, (alone, load_text(load, curve["load_from"]))))
    return AtLoad(load, force_text(load), title, tuple(sentences))


def _thin(
    curves: Sequence[Mapping[str, Any]], runs: Sequence[Mapping[str, Any]]
) -> Iterable[tuple[str, str]]:
    """Name the runs that a curve does without, at loads at which there is one, and say why."""
    for curve in curves:
        load = curve["nominal_normal_force_N"]
        mine = [run for run in runs if run["nominal_normal_force_N"] == load]
        bad = [run for run in mine if is_bad(run)]
        rests = f"{force_text(load)} rests on {len(mine) - len(bad)} of {many(len(mine), 'run')}"
        for run in bad[:_MOST_FINDINGS]:
            yield run["name"], f"{rests}; {status_word(run)}: {_short(why(run))}"


def _short(text: str) -> str:
    first = text.split(". ")[0].rstrip(".")
    return first if len(first) <= _LONGEST else first[:_LONGEST].rsplit(" ", 1)[0] + " …"


def _missing(
    name: str, curves: Sequence[Mapping[str, Any]], runs: Sequence[Mapping[str, Any]]
) -> Iterable[str]:
    """Say at which loads there are runs and no curve, and why."""
    there = {curve["nominal_normal_force_N"] for curve in curves}
    parted = {name for curve in curves for name in curve["runs"]}  # a run may have several loads
    runs = [r for r in runs if r["nominal_normal_force_N"] is not None or r["name"] not in parted]
    loads = dict.fromkeys(run["nominal_normal_force_N"] for run in runs)
    for load in sorted(loads, key=lambda force: force or 0.0):
        if load in there:
            continue
        mine = [run for run in runs if run["nominal_normal_force_N"] == load]
        yield f"{name}, {force_text(load)}: no curve, {_why(mine)}."


def _why(runs: Sequence[Mapping[str, Any]]) -> str:
    failed = [run for run in runs if run["status"] != "done"]
    rejected = [run for run in runs if run["status"] == "done" and is_bad(run)]
    which = {1: "its only run", 2: "both runs"}.get(len(runs), f"all {len(runs)} runs")
    verb = "was" if len(runs) == 1 else "were"
    by_hand = [run for run in rejected if run["quality"] == "rejected"]
    if len(by_hand) == len(runs):
        return f"{which} {verb} rejected by hand"
    if len(rejected) == len(runs):
        by = "" if by_hand else f" by {'its' if len(runs) == 1 else 'their'} checks"
        return f"{which} {verb} rejected{by}"
    if len(failed) == len(runs):
        return f"{which} could not be read"
    if len(failed) + len(rejected) == len(runs):
        count = len(rejected)
        were = "was" if count == 1 else "were"
        return f"{len(failed)} could not be read and {count} {were} rejected"
    if not any(run["segments_found"] for run in runs if not is_bad(run)):
        return f"{which} never {'slides' if len(runs) == 1 else 'slide'} at constant speed"
    return "no run has both a speed and a load"


def _findings(findings: Sequence[Mapping[str, Any]], names: set[str]) -> Iterable[tuple[str, str]]:
    """Return what to look at in these runs and where it stands, the gravest first."""
    grouped: dict[tuple[str, str], list[str]] = {}
    for finding in findings:
        mine = [name for name in finding["run"].split("; ") if name in names]
        if finding["severity"] in _GRAVE and mine:
            grouped.setdefault((finding["severity"], finding["where"]), []).append(
                finding["message"]
            )
    for (severity, where), messages in list(grouped.items())[:_MOST_FINDINGS]:
        more = f" (and {len(messages) - 1} alike)" if len(messages) > 1 else ""
        yield severity, f"{check_words(where)}: {_short(messages[0])}{more}"
    if len(grouped) > _MOST_FINDINGS:
        rest = sum(len(messages) for messages in list(grouped.values())[_MOST_FINDINGS:])
        yield "note", f"{many(rest, 'more finding')}"


def of_nothing(document: Mapping[str, Any]) -> list[str]:
    """Return the names of runs that belong to no surface or medium and have no curve."""
    in_curves = {name for curve in document["curves"] for name in curve["runs"]}
    return [
        run["name"]
        for run in document["runs"]
        if not (run["surface"] or run["medium"]) and run["name"] not in in_curves
    ]
