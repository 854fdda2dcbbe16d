"""Checks for artefacts in heights: dust, scratches, a stuck stylus, rounding."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.core.limit import Limit
from tribolab.core.wording import number
from tribolab.qc.flags import GOOD, SUSPECT
from tribolab.qc.register import Check, Result
from tribolab.qc.scan.artefacts import outlying_features, rounding_step, stuck_stretch
from tribolab.qc.scan.subject import ScanSubject
from tribolab.surface.form import fill_dropouts
from tribolab.surface.roughness import primary_roughness, roughness_parameters

_CALIBRATED = "tests/detection/tricky_scans.py, sets 1000 to 1002, and the scans of ../shared/data"
# seven-point slope of white noise of unit variance, times the pitch (ISO 4287, 4.4.1)
_SLOPE_OF_NOISE = float(np.sqrt(2 * (45**2 + 9**2 + 1)) / 60)


def _rq(profile: xr.Dataset) -> float:
    """Return Rq [m] of a profile without form; Pq if it is shorter than a cut-off allows."""
    try:
        return float(roughness_parameters(profile).Rq)
    except AnalysisError:
        return float(primary_roughness(profile))


def _outliers(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    if not subject.usable or subject.level:
        return [Result("skipped", "height", "there is no roughness to look at")]
    settings = limits["sigma"], limits["factor"], int(limits["most"])
    flags = np.full(subject.rows.shape, GOOD, np.int8)
    values = []
    if subject.is_map:
        if (flat := subject.map_without_form) is None or flat.height.ndim > 2:
            return [Result("skipped", "height", "the map has too few heights")]
        heights = fill_dropouts(flat).height.transpose("y", "x").values
        mask = outlying_features(heights, *settings)
        flags[mask] = SUSPECT
        values = [(float(heights.std()), float(heights[~mask].std()), 0)]
    else:
        for row, profile in zip(subject.usable, subject.form[1], strict=True):
            height = profile.height.values
            mask = outlying_features(height, *settings)
            if not mask.any():
                continue
            flags[row, mask] = SUSPECT
            bare = profile.assign(height=("x", np.where(mask, np.nan, height)))
            values.append((_rq(profile), _rq(bare), row))
    values = [each for each in values if each[0] > (1.0 + limits["effect"]) * each[1]]
    if not values:
        flags[:] = GOOD
        return [Result("pass", "height", "no single peak or valley stands out", 0.0, flags=flags)]
    whole, rest, row = max(values, key=lambda each: each[0] / each[1])
    touched = np.flatnonzero((flags == SUSPECT).any(axis=1))
    row = row if not subject.is_map else int(touched[0])
    at = np.flatnonzero(flags[row] == SUSPECT)
    where = subject.place(row, int(at[0]), int(at[-1]))
    name = "Sq" if subject.is_map else "Rq"
    text = (
        f"a few peaks or valleys exceed all others by far: dust, a scratch or a pore, {where}; "
        f"{name} = {number(1e6 * whole)} um with them, {number(1e6 * rest)} um without"
    )
    others = 0 if subject.is_map else len(values) - 1
    text += f"; and in {others} more" if others else ""
    count = int((flags == SUSPECT).sum())
    return [Result("suspect", "height", text, whole / rest - 1.0, "1", where, count, flags)]


def _stuck(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    if subject.is_map or not subject.usable or subject.level:
        return [Result("skipped", "height", "only profiles with roughness are looked at")]
    flags = np.full(subject.rows.shape, GOOD, np.int8)
    found: list[tuple[int, int, int]] = []
    for row, profile in zip(subject.usable, subject.filled_profiles, strict=True):
        stretch = stuck_stretch(profile.height.values, limits["share"], limits["quiet"])
        if stretch is None:
            continue
        part = slice(*stretch)
        if (~np.isfinite(subject.rows[row, part])).mean() > limits["missing"]:
            continue  # an interpolated gap is also a straight line
        flags[row, part] = SUSPECT
        found.append((row, stretch[0], stretch[1]))
    if not found:
        return [Result("pass", "height", "the heights vary all along", 0.0, flags=flags)]
    row, first, stop = max(found, key=lambda stretch: stretch[2] - stretch[1])
    share, where = (stop - first) / flags[row].size, subject.place(row, first, stop - 1)
    text = f"except for noise, the height is constant over {share:.0%} of the traverse, {where}"
    text += f" and in {len(found) - 1} more" if len(found) > 1 else ""
    count = int((flags == SUSPECT).sum())
    return [Result("suspect", "height", text, share, "1", where, count, flags)]


def _rounding(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    if not subject.usable or subject.level:
        return [Result("skipped", "height", "there is no roughness to look at")]
    worst, text = np.inf, "no digit of the gauge can be seen"
    for row, profile in zip(subject.usable, subject.form[1], strict=True):
        step = rounding_step(subject.rows[row])
        roughness = profile.height.values.std() if subject.is_map else _rq(profile)
        if step > 0 and roughness / step < worst:
            worst = float(roughness / step)
            text = f"the heights are rounded to {number(1e6 * step)} um, {number(1 / worst)} Rq"
            noise = _SLOPE_OF_NOISE * step / np.sqrt(12.0) / subject.pitch
    if not worst < limits["digits"]:
        return [Result("pass", "height", text, worst)]
    text += f"; rounding alone makes a slope of about {number(noise)}, which Rdq includes"
    return [Result("suspect", "height", text, worst)]


ARTEFACT_CHECKS = (
    Check(
        "outliers",
        12,
        "Are there single high peaks or deep valleys, such as dust or scratches?",
        "Inspect this place. Clean the specimen and scan again, or cut this part out.",
        {
            "sigma": Limit(6.0, "1", "peaks of rough surfaces are within 4 to 5", _CALIBRATED),
            "factor": Limit(2.0, "1", "for random heights the largest is 1.5 times the next"),
            "most": Limit(3.0, "1", "more valleys or pores of one size belong to the surface"),
            "effect": Limit(0.05, "1", "Rq of one surface varies as much from spot to spot"),
        },
        _outliers,
    ),
    Check(
        "stuck_stylus",
        13,
        "Does the stylus stay at one height?",
        "Cut the scan there, or scan again. Check whether the stylus sticks or was lifted.",
        {
            "share": Limit(0.08, "1", "shorter flat parts are plateaus or dropouts", _CALIBRATED),
            "quiet": Limit(
                0.5,
                "1",
                "noise of a resting gauge divided by the short-wave roughness",
                _CALIBRATED,
            ),
            "missing": Limit(0.5, "1", "more missing heights are reported as dropouts"),
        },
        _stuck,
    ),
    Check(
        "rounding",
        14,
        "Do the heights have enough digits?",
        "Export more digits or choose a smaller range: rounding dominates Rdq and the "
        "short waves of the spectrum.",
        {"digits": Limit(5.0, "1", "rounding to 0.2 Rq increases Rdq by half", _CALIBRATED)},
        _rounding,
    ),
)
