"""Test of a new dialect on the files from which `tribolab info FILE --write` made it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.core.attributes import RunAttributes, SegmentAttributes
from tribolab.core.errors import TribolabError
from tribolab.core.wording import Count

if TYPE_CHECKING:
    import xarray as xr


def try_on(files: Sequence[Path], dialect: Path, kind: str) -> list[str]:
    """Read files with a new dialect, and return a line on the results of each or on the error.

    Parameters
    ----------
    files
        Files from which the dialect was drafted.
    dialect
        The TOML file.
    kind
        ``run`` or ``scan``.
    """
    lines = []
    for file in files:
        try:
            text = _try_run(file, dialect) if kind == "run" else _try_scan(file, dialect)
        except TribolabError as error:
            text = error.message_for("terminal").removeprefix(f"{file}: ")
        lines.append(f"tried:  {file.name}: {text}")
    return lines


def _try_run(file: Path, dialect: Path) -> str:
    # imported late for a quick start
    from tribolab.arrays.reversals import reversals
    from tribolab.friction.coefficient.coefficient import friction_coefficient, friction_signal
    from tribolab.friction.segments.find import find_segments
    from tribolab.friction.segments.no_segment import why_no_segment
    from tribolab.reading.runs.read_run import read_run

    run = read_run(file, dialect, pair=False)
    time = run["time"].values
    text = f"{Count(len(time)):row|rows} over {float(time[-1]):.4g} s"
    if RunAttributes.from_attrs(run.attrs).rows_are == "points":
        text = f"{Count(len(time)):result|results}, each at one speed"
    if not {"friction_force", "friction_coefficient", "shear_stress"} & set(run.variables):
        return f"{text}; no friction coefficient yet: no column contains the friction"
    try:
        segments = find_segments(run)
        friction = friction_coefficient(run, segments)
    except TribolabError as error:
        why = error.message_for("terminal").removeprefix(f"{file.name}: ")
        return f"{text}; no friction coefficient: {why}"
    if why := why_no_segment(segments):
        return f"{text}; {why}"
    text += f", {Count(segments.sizes['segment']):segment|segments}"
    if "friction_coefficient" not in friction:
        return f"{text}, a friction force without a load: no friction coefficient"
    signal = friction_signal(run)
    turned = reversals(run[signal].values) if _undirected(run, segments) else 0
    if turned:
        return (
            f"{text}; friction changes its sign {turned} times, but no column gives the "
            "direction. This looks like reversing motion, so the mean is not a friction "
            'coefficient. State stroke and frequency under [speed], with source = "stroke"'
        )
    return f"{text}{_coefficients(friction)}"


def _coefficients(friction: xr.Dataset) -> str:
    """Return text on the friction coefficients: their range, mean at one speed, and U95."""
    # imported late for a quick start
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.records.wording import error_text

    name = "friction_coefficient"
    of, values, at = "", friction, ""
    curve = measured_stribeck_curve([friction])
    if 0 < curve.sizes["sliding_speed"] < friction.sizes["segment"]:
        of, values = "means of the segments of a speed, ", curve
        speeds = curve.sizes["sliding_speed"]
        at = f" at {Count(speeds):speed|speeds}" if speeds > 1 else ""
    mu, wide = (np.atleast_1d(values[f"{name}{end}"].values) for end in ("", "_U95"))
    wide, mu = wide[np.isfinite(mu)], mu[np.isfinite(mu)]
    if not mu.size:
        return ""
    if mu.size == 1 and of and np.isfinite(wide[0]):
        count = int(curve["segments"].values[0])
        text = error_text(float(mu[0]), float(wide[0]))
        return f", friction coefficient {text} (U95, mean of {count}; statistical only)"
    span = f"{mu.min():.3g}" + (f" to {mu.max():.3g}" if mu.size > 1 else "")
    known = wide[np.isfinite(wide)]
    width = f"at most {known.max():.2g}" if known.size else "not known"
    return f", friction coefficient {span}{at} ({of}± U95 {width}, statistical only)"


def _undirected(run: xr.Dataset, segments: xr.Dataset) -> bool:
    """Whether neither a measured speed nor the sign of the set speed gives the direction."""
    unknown = bool(segments["sliding_speed"].isnull().any())
    by_set_speed = SegmentAttributes.from_attrs(segments.attrs).velocity_source == "set speed"
    signed = "set_speed" in run and bool((run["set_speed"] < 0).any())
    return unknown or (by_set_speed and not signed)


def _try_scan(file: Path, dialect: Path) -> str:
    # imported late for a quick start
    from tribolab.reading.scan_files import read_scans
    from tribolab.reading.scans.extent import doubt_about_heights

    scan = read_scans(file, dialect)
    height = scan["height"]
    span = float(height.max() - height.min())
    doubt = doubt_about_heights(scan)
    text = f"{Count(height.size):point|points}, heights over {1e6 * span:.4g} um"
    return f"{text}; doubtful: {doubt}" if doubt else text
