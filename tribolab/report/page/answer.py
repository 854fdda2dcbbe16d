"""What a campaign found, in plain words: a card for each surface and medium."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tribolab.records.judgement import check_words, is_bad, status_word, why
from tribolab.records.model_words import is_described, stress_interval
from tribolab.records.wording import with_error
from tribolab.report.live.curves import system_name
from tribolab.report.live.points import point_error
from tribolab.report.plain import listed, plain_speed, plain_speeds
from tribolab.words import aligned, force_text, many

_FLAT = 0.75  # lowest over highest friction of a curve that has no fall to speak of
_SURE = 3.0  # standard errors of a difference that is told
_NEAR = 0.9  # of the highest friction: still on the plateau
_GRAVE = ("fail", "error", "suspect")
_MOST_FINDINGS = 2  # on a card; all of them stand among the findings
_LONGEST = 160  # characters of a finding on a card


@dataclass(frozen=True)
class AtLoad:
    """What was found at one load [N]: sentences, each about one thing."""

    load: float | None
    text: str
    sentences: tuple[str, ...]


@dataclass(frozen=True)
class Card:
    """One surface in one medium: what was found at each load, what is missing, what to look at.

    `figure` is the address of its figure, "" where no curve is known; `thin` are the runs that its
    curves had to do without, each with what is said of it.
    """

    name: str
    surface: str
    medium: str
    figure: str
    found: tuple[AtLoad, ...]
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
    thin = tuple(_thin(curves, runs))
    names = {run["name"] for run in runs} - {name for name, _ in thin}
    return Card(
        name=system_name(surface, medium, curves[0]["runs"] if curves else ()),
        surface=surface,
        medium=medium,
        figure=figure,
        found=tuple(_at_load(document, curve) for curve in curves),
        thin=thin,
        missing=tuple(_missing(system_name(surface, medium), curves, runs)),
        findings=tuple(_findings(document["findings"], names)),
    )


def _at_load(document: Mapping[str, Any], curve: Mapping[str, Any]) -> AtLoad:
    load = curve["nominal_normal_force_N"]
    model = next((m for m in document.get("models", ()) if m["curve"] == curve["name"]), None)
    mode = next((m for m in document.get("sliding_mode", ()) if m["curve"] == curve["name"]), None)
    sentences = [friction_in_words(curve["points"])]
    if mode is not None:
        sentences.append(_sentence(mode["text"]))
    if model is not None and model["fit"] is not None:
        sentences += model_in_words(model["fit"])
    elif model is not None and model["status"] != "skipped":
        sentences.append(_sentence(f"no model: {model['reason'] or 'see the findings'}"))
    return AtLoad(load, force_text(load), tuple(sentences))


def _sentence(text: str) -> str:
    return plain_speeds(f"{text[:1].upper()}{text[1:]}".rstrip(".") + ".")


def friction_in_words(points: Sequence[Mapping[str, Any]]) -> str:
    """Return the shape of a measured curve as a sentence.

    Parameters
    ----------
    points
        Rows of the curve, as in report.json.

    Examples
    --------
    >>> def row(v, mu):
    ...     return {"sliding_speed_m_s": v, "friction_coefficient": mu,
    ...             "friction_coefficient_sem": 0.01, "runs": 2}
    >>> friction_in_words([row(1e-6, 1.1), row(1e-5, 1.08), row(1e-3, 0.7), row(1e-2, 0.2)])
    'Plateau of µ = 1.100 ± 0.010 up to 10 µm/s; half of it at 2 mm/s; lowest 0.200 ± 0.010 at \
10 mm/s, the fastest speed (± between runs).'
    >>> friction_in_words([row(1e-6, 1.1), row(1e-2, 1.05)])
    'µ falls by 4.5 % with speed: from 1.100 ± 0.010 at 1 µm/s to 1.050 ± 0.010 at 10 mm/s (± \
between runs).'
    """
    known = [row for row in points if row["friction_coefficient"] is not None]
    known = sorted(
        (r for r in known if r["sliding_speed_m_s"]), key=lambda r: r["sliding_speed_m_s"]
    )
    if not known:
        return "No friction coefficient at a known speed."
    if len(known) == 1:
        return (
            f"µ = {_mu(known[0])} at {plain_speed(known[0]['sliding_speed_m_s'])}, the only speed"
            f"{_held(known)}."
        )
    high = max(known, key=lambda row: row["friction_coefficient"])
    low = min(known, key=lambda row: row["friction_coefficient"])
    top, bottom = high["friction_coefficient"], low["friction_coefficient"]
    if top > 0 and bottom >= _FLAT * top:
        return f"{_flat(known, low, high)}{_held([low, high])}."
    parts = [_plateau(known, high), _half(known, high)]
    where = plain_speed(low["sliding_speed_m_s"])
    side = {id(known[0]): ", the slowest speed", id(known[-1]): ", the fastest speed"}
    parts.append(f"lowest {_mu(low)} at {where}{side.get(id(low), '')}")
    return "; ".join(filter(None, parts)) + f"{_held([high, low])}."


def _flat(known: list[Mapping[str, Any]], low: Mapping[str, Any], high: Mapping[str, Any]) -> str:
    """Say how a curve without a fall depends on speed; `known` from slow to fast."""
    first, last = (plain_speed(known[k]["sliding_speed_m_s"]) for k in (0, -1))
    change = high["friction_coefficient"] - low["friction_coefficient"]
    error = math.hypot(*(row["friction_coefficient_sem"] or 0.0 for row in (low, high)))
    between = f"from {first} to {last}"
    if change <= _SURE * error:
        return f"µ hardly depends on speed: {_mu(low)} to {_mu(high)} {between}"
    share = f"{100 * change / high['friction_coefficient']:.2g} %"
    if {id(low), id(high)} != {id(known[0]), id(known[-1])}:
        return f"µ varies by {share} with speed: {_mu(low)} to {_mu(high)} {between}"
    way = "rises" if high is known[-1] else "falls"
    ends = f"from {_mu(known[0])} at {first} to {_mu(known[-1])} at {last}"
    return f"µ {way} by {share} with speed: {ends}"


def _held(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return what the errors of a sentence hold, in brackets; "" where none is known."""
    errors = [point_error(row, ()) for row in rows]
    held = dict.fromkeys(error.holds for error in errors if error.size is not None)
    return f" (± {' and '.join(held)})" if held else ""


def _mu(row: Mapping[str, Any]) -> str:
    return with_error(row["friction_coefficient"], point_error(row, ()).size)


def _plateau(known: Sequence[Mapping[str, Any]], high: Mapping[str, Any]) -> str:
    top = high["friction_coefficient"]
    at = known.index(high)
    near = [row for row in known[at:] if row["friction_coefficient"] >= _NEAR * top]
    slow = all(row["friction_coefficient"] >= _NEAR * top for row in known[: at + 1])
    if slow and len(near) + at > 1:
        return f"Plateau of µ = {_mu(high)} up to {plain_speed(near[-1]['sliding_speed_m_s'])}"
    return f"Highest µ = {_mu(high)} at {plain_speed(high['sliding_speed_m_s'])}"


def _half(known: Sequence[Mapping[str, Any]], high: Mapping[str, Any]) -> str:
    speed = half_speed(known[known.index(high) :])
    return "" if speed is None else f"half of it at {plain_speed(speed)}"


def half_speed(falling: Sequence[Mapping[str, Any]]) -> float | None:
    """Return the speed at which half of the first row's friction is left [m/s]; None if at none.

    Parameters
    ----------
    falling
        Rows of a curve from its highest friction on, in the order of their speeds.
    """
    half = 0.5 * falling[0]["friction_coefficient"]
    for row, other in itertools.pairwise(falling):
        a, b = row["friction_coefficient"], other["friction_coefficient"]
        if a >= half > b:
            share = (a - half) / (a - b)
            v, w = (math.log(each["sliding_speed_m_s"]) for each in (row, other))
            return math.exp(v + share * (w - v))
    return None


def model_in_words(fit: Mapping[str, Any]) -> list[str]:
    """Return what the model says of a curve: the shear stress, and what it cannot explain.

    Parameters
    ----------
    fit
        Of a model, as in report.json.

    Examples
    --------
    >>> model_in_words({"shear_stress_Pa": 0.84e6, "shear_stress_low_Pa": 0.8e6,
    ...     "shear_stress_high_Pa": 0.88e6, "judgement":
    ...     "the model does not describe this curve: off by up to 85 % of its height; no range"})
    ['The model does not describe this curve: off by up to 85 % of its height.']
    """
    verdict = str(fit["judgement"]).split(";")[0]
    if not is_described(str(fit["judgement"])):
        return [_sentence(verdict)]
    stress, low = fit["shear_stress_Pa"], fit["shear_stress_low_Pa"]
    interval = stress_interval(low, fit["shear_stress_high_Pa"])
    if low is not None and low <= 0:
        text = f"Shear stress {interval} MPa (95 %)"
    else:
        text = f"Shear stress {aligned(stress * 1e-6)} MPa (95 %: {interval} MPa)"
    return [f"{text}.", _sentence(verdict)]


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


def conditions(of: Sequence[Mapping[str, Any]]) -> str:
    """Return the conditions of curves or models in words, loads of the same kind together.

    Examples
    --------
    >>> of = [{"surface": "Sb-R", "medium": "dry", "nominal_normal_force_N": load}
    ...       for load in (31.0, 91.0)]
    >>> conditions(of)
    'Sb-R, dry, at 31 N and 91 N'
    """
    grouped: dict[str, list[str]] = {}
    for curve in of:
        loads = grouped.setdefault(system_name(curve["surface"], curve["medium"]), [])
        loads.append(force_text(curve["nominal_normal_force_N"]))
    return "; ".join(f"{name}, at {listed(loads)}" for name, loads in grouped.items())


def oscillation_text(mode: Mapping[str, Any]) -> str:
    """Return in how many segments a contact sticks and slips, and how its frequency goes.

    Parameters
    ----------
    mode
        A sliding mode, as in report.json.
    """
    count = mode["segments_oscillating"]
    if not count:
        return ""
    of = f"{count} of {many(mode['segments'], 'segment')}"
    if mode["verdict"] == "no stick-slip":
        verb = "looks" if count == 1 else "look"
        return f"{of} alone {verb} like stick-slip, as noise does now and then."
    text = f"Stick-slip in {of}."
    if mode["scaling_exponent"] is not None:
        power = with_error(mode["scaling_exponent"], mode["scaling_error"])
        scaling = str(mode["scaling"])
        text += f" {scaling[:1].upper()}{scaling[1:]} (frequency goes with speed to the {power})."
    return text
