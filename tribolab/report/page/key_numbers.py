"""Tables of key numbers for the page: friction, running-in, roughness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import load_text
from tribolab.figures.spec import KeyRow, KeyTable
from tribolab.records.judgement import is_bad, is_odd
from tribolab.records.models.model_words import is_described, stress_interval
from tribolab.records.parts import Row, number_of
from tribolab.records.runs.running_in_record import RunningIn, length_text, mean_of_steady
from tribolab.records.surfaces.roughness_words import roughness_u95
from tribolab.records.verdict import has_unknown_zero
from tribolab.records.wording import error_text
from tribolab.report.page.in_words import by_speed, half_speed
from tribolab.report.page_figures.curves import system_name
from tribolab.report.page_figures.points import point_error
from tribolab.report.plain import plain_speed


def friction_numbers(document: Mapping[str, Any]) -> KeyTable:
    """Return a table with highest and lowest µ of each curve, fitted shear stress and Rq."""
    models = {model["curve"]: model["fit"] for model in document.get("models", ())}
    rough = {
        surface["name"]: error_text(
            1e6 * surface["roughness"]["Rq_m"],
            None if (u := roughness_u95(surface["roughness"], "Rq")) is None else 1e6 * u,
        )
        for surface in document.get("surfaces", ())
        if surface["roughness"] and surface["roughness"]["Rq_m"] is not None
    }
    single = all(len(curve["points"]) < 2 for curve in document["curves"])
    extremes = ["Highest µ ± U95", "Speed at half of highest µ", "Lowest µ ± U95"]
    heads = ["Condition", "Load", *(["µ ± U95"] if single else extremes)]
    heads += ["Fitted shear stress (MPa)"] * bool(models) + ["Rq (µm)"] * bool(rough)
    odd = {run["name"] for run in document["runs"] if is_odd(run)}
    rows = []
    for curve in document["curves"]:
        known = by_speed(curve["points"])
        if not known:
            continue
        name = system_name(curve["surface"], curve["medium"], curve["runs"])
        if unlike := odd.intersection(curve["runs"]):
            name += f" (▲ includes {', '.join(sorted(unlike))})"
        cells = [name, load_text(curve["nominal_normal_force_N"], curve["load_from"])]
        cells += [_at_speed(known[0]) + _zero(document, curve)] if single else _extremes(known)
        cells += [_stress(models.get(curve["name"]))] * bool(models)
        cells += [rough.get(curve["surface"], "–")] * bool(rough)
        labels = curve["surface"], curve["medium"], curve["nominal_normal_force_N"]
        rows.append(KeyRow(tuple(cells), *labels))
    return KeyTable(tuple(heads), tuple(rows))


def _extremes(known: Sequence[Mapping[str, Any]]) -> list[str]:
    high = max(known, key=lambda row: row["friction_coefficient"])
    low = min(known, key=lambda row: row["friction_coefficient"])
    half = half_speed(known[known.index(high) :]) if high["friction_coefficient"] > 0 else None
    return [_at_speed(high), "not reached" if half is None else plain_speed(half), _at_speed(low)]


def _at_speed(row: Mapping[str, Any]) -> str:
    mu = error_text(row["friction_coefficient"], point_error(row, ()).size)
    return f"{mu} at {plain_speed(row['sliding_speed_m_s'])}"


def _zero(document: Mapping[str, Any], curve: Mapping[str, Any]) -> str:
    runs = [run for run in document["runs"] if run["name"] in curve["runs"]]
    return ", zero unknown" * any(has_unknown_zero(run["checks"]) for run in runs)


def _stress(fit: Mapping[str, Any] | None) -> str:
    """Return text on the fitted shear stress and its 95 % interval, or why there is none."""
    if fit is None:
        return "–"
    if not is_described(str(fit["judgement"])):
        return "model fails"
    interval = stress_interval(fit["shear_stress_low_Pa"], fit["shear_stress_high_Pa"])
    return f"{fit['shear_stress_Pa'] * 1e-6:.3g} ({interval})"


def settled_numbers(document: Mapping[str, Any]) -> KeyTable | None:
    """Return a table of running-in and steady friction of all runs at one speed, if there are any.

    The first rows are the means of repeats, with U95 from the scatter between them. If some repeats
    contradict the others, a second mean excludes them.
    """
    rows = []
    repeats: dict[tuple[str, str, float | None, str], dict[str, RunningIn]] = {}
    odd = {run["name"] for run in document["runs"] if is_odd(run)}
    for run in document["runs"]:
        if len(run["running_in"]) != 1:
            continue
        settled = RunningIn(**{each.name: run["running_in"][0][each.name] for each in _FIELDS})
        finished = settled.steady_friction_coefficient is not None
        begin, end = map(length_text, (settled.start_m, settled.end_m))
        over = "not finished" if not finished else begin if settled.start_m else "none"
        steady = error_text(
            settled.steady_friction_coefficient, settled.steady_friction_coefficient_U95
        )
        # if friction changes along the run, this mean depends on the length of the run
        mean = error_text(settled.mean_friction_coefficient, settled.error_of_mean)
        cells = (
            run["name"],
            steady if finished else "–",
            mean,
            f"{over} of {end}" if finished and settled.start_m else over,
            "steady" if finished and settled.start_m else settled.verdict,
            plain_speed(settled.sliding_speed_m_s),
        )
        condition = run["surface"], run["medium"], run["nominal_normal_force_N"]
        rows.append(KeyRow(cells, *condition))
        if finished and not is_bad(run):
            repeats.setdefault((*condition, cells[-1]), {})[run["name"]] = settled
    means = []
    for (surface, medium, load, speed), each in repeats.items():
        without = ", ".join(name for name in each if name in odd)
        agreeing = [row for name, row in each.items() if name not in odd]
        for used, ends in ((list(each.values()), ""), (agreeing, f", without {without}")):
            found = mean_of_steady(used) if len(used) > 1 else None
            if found is not None and (without or not ends):
                name = f"mean of {len(used)} repeats{ends}"
                words = name, error_text(found.mean, found.u95), "", "", "", speed
                means.append(KeyRow(words, surface, medium, load))
    rows = [*means, *rows]
    return KeyTable(_SETTLED_HEADS, tuple(rows)) if rows else None


_FIELDS = fields(RunningIn)
_MEANS = "Steady µ ± U95", "Whole-run mean"
_SETTLED_HEADS = "Run", *_MEANS, "Running-in distance", "After running-in", "Speed"


def roughness_numbers(document: Mapping[str, Any]) -> KeyTable:
    """Return a table with roughness, slope, Hurst exponent and number of scans per surface."""
    rows = []
    for surface in document["surfaces"]:
        row = surface["roughness"]
        if row is None:
            cells = (surface["name"], surface["reason"] or "no scan", *[""] * 5)
        else:
            cells = (
                surface["name"],
                *(_micrometres(row, name) for name in ("Ra", "Rq", "Rz")),
                error_text(row["measured_rms_slope"], None),
                error_text(row["hurst_exponent"], _u95(row["hurst_exponent_standard_error"])),
                f"{row['scans']:g} of {len(surface['files'])}",
            )
        rows.append(KeyRow(cells, surface["name"]))
    heads = (
        "Surface",
        "Ra ± U95 (µm)",
        "Rq ± U95 (µm)",
        "Rz ± U95 (µm)",
        "Measured rms slope",
        "Hurst exponent",
        "Scans",
    )
    return KeyTable(heads, tuple(rows))


def _u95(standard_error: float | None) -> float | None:
    return None if standard_error is None else NORMAL * standard_error


def _micrometres(row: Row, name: str) -> str:
    value, error = number_of(row, f"{name}_m"), roughness_u95(row, name)
    return error_text(
        None if value is None else 1e6 * value, None if error is None else 1e6 * error
    )
