"""Curves, models and modes in plain words: a sentence about one thing."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tribolab.records.model_words import is_described, stress_interval
from tribolab.records.wording import NORMAL, with_error
from tribolab.report.live.curves import system_name
from tribolab.report.live.points import point_error
from tribolab.report.plain import listed, plain_speed, plain_speeds
from tribolab.words import aligned, force_text, many

_FLAT = 0.75  # lowest over highest friction of a curve that has no fall to speak of
_SURE = 1.5  # U95 of a difference that is stated: three standard errors
_NEAR = 0.9  # of the highest friction: still on the plateau


def sentence(text: str) -> str:
    """Return a text as a sentence, its speeds as people write them."""
    return plain_speeds(f"{text[:1].upper()}{text[1:]}".rstrip(".") + ".")


def by_speed(points: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return the rows of a curve with friction at a known speed, from slow to fast."""
    known = [r for r in points if r["friction_coefficient"] is not None and r["sliding_speed_m_s"]]
    return sorted(known, key=lambda row: row["sliding_speed_m_s"])


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
    ...             "friction_coefficient_U95": 0.01, "runs": 2}
    >>> friction_in_words([row(1e-6, 1.1), row(1e-5, 1.08), row(1e-3, 0.7), row(1e-2, 0.2)])
    'Plateau of µ = 1.100 ± 0.010 up to 10 µm/s; half of it at about 2 mm/s; lowest 0.200 ± \
0.010 at 10 mm/s, the fastest speed (± U95, between runs).'
    >>> friction_in_words([row(1e-6, 1.1), row(1e-2, 1.05)])
    'µ falls by 4.5 % with speed: from 1.100 ± 0.010 at 1 µm/s to 1.050 ± 0.010 at 10 mm/s (± \
U95, between runs).'
    """
    known = by_speed(points)
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
    error = math.hypot(*(point_error(row, ()).size or 0.0 for row in (low, high)))
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
    return f" (± U95, {' and '.join(held)})" if held else ""


def _mu(row: Mapping[str, Any]) -> str:
    return with_error(row["friction_coefficient"], point_error(row, ()).size)


def _plateau(known: Sequence[Mapping[str, Any]], high: Mapping[str, Any]) -> str:
    at = known.index(high)
    near = list(itertools.takewhile(lambda row: _as_high(row, high), known[at:]))
    slow = all(_as_high(row, high) for row in known[:at])
    if slow and len(near) + at > 1:
        return f"Plateau of µ = {_mu(high)} up to {plain_speed(near[-1]['sliding_speed_m_s'])}"
    return f"Highest µ = {_mu(high)} at {plain_speed(high['sliding_speed_m_s'])}"


def _as_high(row: Mapping[str, Any], high: Mapping[str, Any]) -> bool:
    """Whether a point belongs to the plateau of the highest: near it, and within their errors."""
    lower = high["friction_coefficient"] - row["friction_coefficient"]
    if lower > (1 - _NEAR) * high["friction_coefficient"]:
        return False
    errors = [point_error(each, ()).size for each in (row, high)]
    return None in errors or lower <= _SURE * math.hypot(*(error or 0.0 for error in errors))


def _half(known: Sequence[Mapping[str, Any]], high: Mapping[str, Any]) -> str:
    speed = half_speed(known[known.index(high) :])
    return "" if speed is None else f"half of it at about {plain_speed(speed)}"


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
        return [sentence(verdict)]
    stress, low = fit["shear_stress_Pa"], fit["shear_stress_low_Pa"]
    interval = stress_interval(low, fit["shear_stress_high_Pa"])
    if low is not None and low <= 0:
        text = f"Shear stress {interval} MPa (95 %)"
    else:
        text = f"Shear stress {aligned(stress * 1e-6)} MPa (95 %: {interval} MPa)"
    return [f"{text}.", sentence(verdict)]


def conditions(of: Sequence[Mapping[str, Any]]) -> str:
    """Return the conditions of curves or models in words, loads of the same kind together.

    Examples
    --------
    >>> of = [{"surface": "Sb-R", "medium": "dry", "nominal_normal_force_N": load}
    ...       for load in (31.0, 91.0)]
    >>> conditions(of)
    'Sb-R, dry, at 31 N and 91 N'
    """
    grouped: dict[str, list[float | None]] = {}
    for curve in of:
        if not (curve["surface"] or curve["medium"]) and "condition" in curve:
            grouped[curve["condition"]] = [None]  # the load is in it
            continue
        name = system_name(curve["surface"], curve["medium"], curve.get("runs", ()))
        grouped.setdefault(name, []).append(curve["nominal_normal_force_N"])
    return "; ".join(
        name if loads == [None] else f"{name}, at {listed(list(map(force_text, loads)))}"
        for name, loads in grouped.items()
    )


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
        power = with_error(mode["scaling_exponent"], NORMAL * mode["scaling_error"])
        scaling = str(mode["scaling"])
        text += f" {scaling[:1].upper()}{scaling[1:]} (frequency goes with speed to the {power})."
    return text
