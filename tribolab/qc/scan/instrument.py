"""Checks on stated values of a scan: pitch, length, and the instrument's own roughness."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.limit import Limit
from tribolab.qc.register import Check, Result
from tribolab.qc.scan.subject import ScanSubject
from tribolab.reading.scans.extent import doubt_about_heights, impossible_heights
from tribolab.surface.roughness import roughness_parameters

_COMPARED = ("Ra", "Rq")


def _spacing(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    unevenness = max(subject.attribute_values("x_unevenness"), default=float("nan"))
    steps = np.diff(subject.x)
    here = float(np.abs(steps / subject.pitch - 1.0).max())
    resampled = "resampled" in subject.scans.attrs
    if np.isnan(unevenness):
        unevenness = here
    if unevenness <= limits["even"]:
        return [Result("pass", "x", "the points are evenly spaced", unevenness)]
    if not resampled:
        text = (
            f"the positions in the file are uneven by up to {unevenness:.2g} steps, which "
            "rounding of their last digit explains: treated as even"
        )
        return [Result("pass", "x", text, unevenness, noted=True)]
    text = (
        f"the positions in the file are uneven by up to {unevenness:.2g} steps, more than their "
        "rounding: heights were interpolated, which removes short waves"
    )
    return [Result("suspect", "x", text, unevenness)]


def _length(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    attrs = subject.scans.attrs
    real = {"length": float(subject.x[-1] - subject.x[0]), "pitch": subject.pitch}
    results = []
    for name, unit, size in (("length", "mm", 1e3), ("pitch", "um", 1e6)):
        stated = subject.attribute_values(f"stated_{name}_m")
        if not stated or np.isnan(stated).all():
            continue
        is_attr = subject.attribute_values(f"{name}_m")
        stated_ones = np.broadcast_to(is_attr if is_attr else [real[name]], len(stated))
        # n points have n - 1 steps; a length of n steps is accepted too
        allowance = real["pitch"] if name == "length" else 0.0
        apart = np.maximum(np.abs(np.array(stated) - stated_ones) - allowance, 0.0) / stated_ones
        row = int(np.nanargmax(apart))
        value = float(apart[row])
        status = "pass" if value <= limits["suspect"] else "suspect"
        status = "fail" if value > limits["fail"] else status
        text = (
            f"the file states a {name} of {stated[row] * size:.6g} {unit}, its positions give "
            f"{stated_ones[row] * size:.6g} {unit}"
        )
        results.append(Result(status, name, text, value))
    if (short := _point_count(subject)) is not None:
        results.append(short)
    if (odd := _implausible_size(subject, limits)) is not None:
        results.append(odd)
    if not results and attrs.get("stated_length_m") is None:
        return [
            Result(
                "skipped", "length", "the file states no length and no pitch besides its positions"
            )
        ]
    return results


def _point_count(subject: ScanSubject) -> Result | None:
    """Return a result if the number of points differs from that stated in the file; else None."""
    stated = [number for number in subject.attribute_values("stated_points") if np.isfinite(number)]
    points = subject.scans.sizes["x"]
    if subject.is_map or not stated or all(abs(number - points) <= 1 for number in stated):
        return None
    other = next(number for number in stated if abs(number - points) > 1)
    text = f"the file states {other:.0f} points but contains {points}: is it complete?"
    return Result("suspect", "height", text, float(points))


def _implausible_size(subject: ScanSubject, limits: Mapping[str, float]) -> Result | None:
    """Return a result if a scan is longer or steeper than real surfaces; else None."""
    length = float(subject.x[-1] - subject.x[0])
    largest = limits["map"] if subject.is_map else limits["profile"]
    if length > largest:
        text = f"the scan is {length:.4g} m long according to its units"
        return Result("suspect", "length", text, length, "m")
    if impossible := impossible_heights(subject.scans):
        return Result("suspect", "height", impossible)
    _, profiles = subject.form
    if not profiles or subject.level:
        return None
    slopes = [float(np.diff(profile.height.values).std()) / subject.pitch for profile in profiles]
    steepest = max(slopes)
    if steepest > limits["slope"]:
        text = (
            f"the rms slope is {steepest:.3g}, {np.degrees(np.arctan(steepest)):.3g} deg: such "
            "slopes are impossible, so the unit of the heights or that of x is wrong"
        )
        return Result("suspect", "pitch", text, steepest)
    doubt = doubt_about_heights(subject.scans)
    return Result("pass", "height", doubt, steepest, noted=True) if doubt else None


def _own_results(subject: ScanSubject) -> list[tuple[str, dict[str, float], float]]:
    """Return roughness values of the instrument: source, values [m], cut-off [m] (NaN: unknown)."""
    sets = []
    for number, result in enumerate(subject.results, start=1):
        values = {n: float(result[n]) for n in _COMPARED if n in result}
        cut = float(result.attrs.get("lambda_c_m", np.nan))
        sets.append((str(result.attrs.get("source", f"results {number}")), values, cut))
    own = {name: subject.attribute_values(f"instrument_{name}_m") for name in _COMPARED}
    cut = min(subject.attribute_values("lambda_c_m"), default=float("nan"))
    for row in range(max((len(v) for v in own.values()), default=0)):
        values = {n: v[row] for n, v in own.items() if row < len(v)}
        sets.append((subject.names[min(row, len(subject.names) - 1)], values, cut))
    return sets


def _computed_roughness(profile: xr.Dataset, cut: float) -> list[dict[str, float]]:
    """Return roughness that the instrument may have computed: with a cut-off, or levelled only."""
    parameters = []
    for cutoff in ("auto", None) if np.isnan(cut) else (cut, None):
        try:
            values = roughness_parameters(profile, lambda_c=cutoff)
        except AnalysisError:  # shorter than two cut-offs
            continue
        parameters.append({name: float(values[name]) for name in _COMPARED})
    return parameters


def uncomputed_values(results: xr.Dataset) -> Result | None:
    """Return a result if the instrument could not compute some values; else None."""
    errors = str(results.attrs.get("instrument_errors", "none"))
    if errors in ("", "none"):
        return None
    source = str(results.attrs.get("source", "results"))
    text = f"{source}: the instrument could not compute {errors}"
    return Result("suspect", "results", text, count=errors.count(":"))


def _results(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for result in subject.results:
        if (missing := uncomputed_values(result)) is not None:
            results.append(missing)
    sets = _own_results(subject)
    if not sets and not results:
        return [Result("skipped", "Ra", "the file contains no results of the instrument")]
    _, profiles = subject.form
    if subject.is_map or not profiles or subject.level:
        return results or [Result("skipped", "Ra", "there is no profile to compare with")]
    cut = sets[0][2] if sets else float("nan")
    ours = [_computed_roughness(profile, cut) for profile in profiles]
    for number, (source, values, cut) in enumerate(sets):
        alone = len(sets) == len(profiles) == len(subject.rows)  # one set of values per profile
        candidates = ours[number] if alone else [parameters for many in ours for parameters in many]
        for name, value in values.items():
            computed = [parameters[name] for parameters in candidates if parameters[name] > 0]
            if not computed or not np.isfinite(value) or value <= 0:
                continue
            closest = min(computed, key=lambda own: abs(np.log(own / value)))
            apart = float(np.exp(abs(np.log(closest / value)))) - 1.0
            grave = not np.isnan(cut) and apart > limits["fail"]
            grave = grave or apart > limits["unknown_filter"]
            status = "fail" if grave else "suspect" if apart > limits["suspect"] else "pass"
            text = (
                f"{source}: the instrument's {name} is {value * 1e6:.4g} um, the computed one "
                f"{closest * 1e6:.4g} um"
            )
            if np.isnan(cut):
                text += "; the file does not state the instrument's filter"
            results.append(Result(status, name, text, apart))
    return results


INSTRUMENT_CHECKS = (
    Check(
        "spacing",
        6,
        "Are the points of the scan evenly spaced?",
        "Export x with more digits, or the heights with only the pitch.",
        {"even": Limit(0.01, "1", "1 % of a step does not affect any wave")},
        _spacing,
    ),
    Check(
        "length",
        7,
        "Do length and pitch agree with those stated in the file?",
        "Check the units of heights and x, and whether the scan is complete.",
        {
            "suspect": Limit(0.01, "1", "run-in and rounding cause less than 1 %"),
            "fail": Limit(0.1, "1", "an error of 10 % in the wavenumbers changes C by a third"),
            "profile": Limit(1.0, "m", "drive units reach at most a fifth of this"),
            "map": Limit(0.5, "m", "few areal instruments have this range"),
            "slope": Limit(20.0, "1", "87 deg: no gauge follows such flanks everywhere"),
        },
        _length,
    ),
    Check(
        "results",
        9,
        "Do the Ra and Rq of the instrument agree with the profile?",
        "Check units, filter and whether Ra and Rq belong to this profile. If values are "
        "missing, make a longer or cleaner scan.",
        {
            "suspect": Limit(0.1, "1", "end effects of filter and form cause up to 10 %"),
            "fail": Limit(
                0.5, "1", "with a known filter, a difference of 50 % means a different profile"
            ),
            "unknown_filter": Limit(9.0, "1", "a factor of ten means a wrong unit, for any filter"),
        },
        _results,
    ),
)
