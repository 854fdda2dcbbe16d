"""What a campaign found, in a line or two above all its cards."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.records.model_words import is_described
from tribolab.records.notice_words import STEPS_DIFFER, TRENDS
from tribolab.records.roughness_words import roughness_in_words
from tribolab.records.trends import undecided_trends
from tribolab.report.page.in_words import by_speed, conditions, half_speed
from tribolab.report.plain import listed, plain_speed
from tribolab.words import force_text, is_dry, many

_MOST = 3  # runs of which it is told one by one


class Fall(NamedTuple):
    """Speed at which half of a surface's friction is left [m/s], None if at none; the fastest."""

    surface: str
    half: float | None
    fastest: float


def in_short(document: Mapping[str, Any]) -> list[str]:
    """Return which surface lifts off last, which curves no model describes, trends, and roughness.

    Parameters
    ----------
    document
        As in report.json.

    Examples
    --------
    >>> def curve(surface, falls):
    ...     rows = [{"sliding_speed_m_s": v, "friction_coefficient": mu}
    ...             for v, mu in ((1e-6, 1.0), (falls, 0.25), (1e-2, 0.2))]
    ...     return {"surface": surface, "medium": "oil", "nominal_normal_force_N": 31.0,
    ...             "name": surface, "points": rows}
    >>> (said,) = in_short({"curves": [curve("fine", 1e-5), curve("rough", 1e-3)]})
    >>> said.partition(", ")[0], said.partition(": ")[2]
    ('In oil at 31 N', 'rough needs the highest speed to lift off.')
    """
    rough = ((s["name"], s["roughness"]) for s in document.get("surfaces", ()) if s["roughness"])
    along = _along(document.get("findings", ()))
    known = [run for run in document.get("runs", ()) if run.get("segments")]
    runs = ((run["name"], run["segments"], run["quantity"] or "") for run in known)
    open_ = [f"{text}." for text in [undecided_trends(runs)] if text]
    roughness = roughness_in_words(rough)
    return [*_falls(document["curves"]), *_models(document), *along, *open_, *roughness]


def _along(findings: Iterable[Mapping[str, Any]]) -> list[str]:
    """Say of which runs friction changes from stroke to stroke or from step to step."""
    told = [row for row in findings if row["message"].startswith((*TRENDS, STEPS_DIFFER))]
    if len(told) > _MOST:
        return [f"Friction changes along {many(len({row['run'] for row in told}), 'run')}."]
    return [f"{row['run']}: {row['message']}." for row in told]


def _falls(curves: Iterable[Mapping[str, Any]]) -> Iterable[str]:
    media: dict[str, dict[float, list[Mapping[str, Any]]]] = {}
    for curve in curves:
        load = curve["nominal_normal_force_N"]
        if curve["surface"] and curve["medium"] and load is not None:
            media.setdefault(curve["medium"], {}).setdefault(load, []).append(curve)
    for medium, loads in media.items():
        # the load at which most surfaces were measured, of those the lowest
        load = min(loads, key=lambda force: (-len(loads[force]), force))
        falls = list(filter(None, map(_fall, loads[load])))
        if len(falls) > 1 and any(fall.half is not None for fall in falls):
            where = "Dry" if is_dry(medium) else f"In {medium}"
            told = listed([_told(fall) for fall in falls])
            falls_so_far = "friction falls to half of its highest"
            if not is_dry(medium):
                falls_so_far += ", as the liquid begins to lift the surfaces apart,"
            yield f"{where} at {force_text(load)}, {falls_so_far} {told}{_last(falls, medium)}."


def _fall(curve: Mapping[str, Any]) -> Fall | None:
    known = by_speed(curve["points"])
    if not known:
        return None
    high = max(known, key=lambda row: row["friction_coefficient"])
    half = half_speed(known[known.index(high) :])
    return Fall(curve["surface"], half, known[-1]["sliding_speed_m_s"])


def _told(fall: Fall) -> str:
    if fall.half is None:
        return f"not yet at {plain_speed(fall.fastest)} on {fall.surface}"
    return f"at {plain_speed(fall.half)} on {fall.surface}"


def _last(falls: Sequence[Fall], medium: str) -> str:
    """Name the surface that needs the highest speed, where the measured speeds tell it."""
    order = sorted(falls, key=lambda fall: fall.half if fall.half is not None else fall.fastest)
    last = order[-1]
    if sum(fall.half is None for fall in falls) > (last.half is None):
        return ""
    return f": {last.surface} needs the highest speed" + (
        " to lift off" if not is_dry(medium) else ""
    )


def _models(document: Mapping[str, Any]) -> Iterable[str]:
    fits = {m["curve"]: m["fit"] for m in document.get("models", ()) if m["fit"] is not None}
    failing = [
        curve
        for curve in document["curves"]
        if curve["name"] in fits and not is_described(str(fits[curve["name"]]["judgement"]))
    ]
    if failing:
        of = f"{len(failing)} of {many(len(fits), 'curve')}"
        yield f"The model fails on {of}: {conditions(failing)}."
    elif fits:
        yield f"The model describes {many(len(fits), 'curve')}."
