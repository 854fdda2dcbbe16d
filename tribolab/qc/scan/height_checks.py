"""Checks on single heights of a scan: missing, jumping or clipped."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.qc import signals
from tribolab.qc.flags import FAIL, SUSPECT
from tribolab.qc.register import Check, Result
from tribolab.qc.scan import profiles
from tribolab.qc.scan.artefacts import longest_run
from tribolab.qc.scan.subject import ScanSubject


def _flag_result(
    subject: ScanSubject, flags: np.ndarray, text: str, fail_share: float
) -> list[Result]:
    """Return the result of a check from its flags (row, x): severity, points and place."""
    bad = np.isin(flags, (SUSPECT, FAIL))
    count = int(bad.sum())
    share = count / flags.size
    if not count:
        return [Result("pass", "height", "nothing found", 0.0, flags=flags)]
    grave = share > fail_share
    if grave:
        flags = np.where(bad, FAIL, flags).astype(np.int8)
    row = int(np.argmax(bad.any(axis=1)))
    at = np.flatnonzero(bad[row])
    where = subject.place(row, int(at[0]), int(at[-1]))
    others = int(bad.any(axis=1).sum()) - 1
    message = (
        text.format(count=Count(count))
        + f", {where}"
        + (f" and in {others} more" if others else "")
    )
    status = "fail" if grave else "suspect"
    return [Result(status, "height", message, share, "1", where, count, flags)]


def _dropouts(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    missing = ~np.isfinite(subject.rows)
    flags = signals.missing(np.where(missing, np.nan, 0.0))
    cropped = str(subject.scans.attrs.get("cropped", ""))
    if not missing.any():
        text = cropped or "nothing missing"
        return [Result("pass", "height", text, 0.0, flags=flags, noted=bool(cropped))]
    ends = np.zeros_like(missing) if subject.is_map else profiles.end_points(missing)
    inside = missing & ~ends
    count, share = int(missing.sum()), float(inside.mean())
    row = int(np.argmax([longest_run(m) for m in inside]))
    if not inside[row].any():
        row = int(np.argmax(ends.any(axis=1)))
        at = np.flatnonzero(ends[row])
        where = subject.place(row, int(at[0]), int(at[-1]))
        text = f"{Count(count):height is|heights are} missing at the ends, which are left out"
        left_out = float(ends.mean(axis=1).max())
        status = "suspect" if left_out > limits["stretch"] else "pass"
        if left_out > limits["fail"]:
            status = "fail"
        cure = "Let the scan begin and end on the surface."
        return [Result(status, "height", text, left_out, "1", where, count, flags, True, cure)]
    longest = longest_run(inside[row])
    at = np.flatnonzero(inside[row])
    where = subject.place(row, int(at[0]), int(at[-1]))
    span = longest * subject.pitch
    text = (
        f"{Count(count):height is|heights are} missing ({missing.mean():.2%}), at most {longest} "
        f"in a row ({span * 1e6:.4g} um), {where}"
    )
    text += f"; {cropped}" if cropped else ""
    whole = float(subject.x[-1] - subject.x[0])
    # a gap in a map has measured rows next to it, a gap in a profile has not
    far = not subject.is_map and span > limits["stretch"] * whole
    status = "pass"
    if share > limits["suspect"] or longest > limits["in_a_row"] or far:
        status = "suspect"
    if _most_missing(subject) > limits["fail"]:
        status = "fail"
    elif far and (cost := profiles.cost_of_gaps(subject.profile_of(row))):
        text += f"; it leaves {cost}"
    return [Result(status, "height", text, share, "1", where, count, flags, noted=True)]


def _most_missing(subject: ScanSubject) -> float:
    """Return the largest share of missing heights among the maps or profiles."""
    missing = ~np.isfinite(subject.rows)
    return float(missing.mean() if subject.is_map else missing.mean(axis=1).max())


def _steps(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    flags = np.stack([profiles.steps(row, limits["factor"]) for row in subject.rows])
    return _flag_result(subject, flags, "the height jumps {count:time|times}", limits["fail"])


def _clipping(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    fewest, share = int(limits["points"]), limits["noisy"]
    noisy = 1.0 if subject.is_map else share
    flags = np.stack([profiles.flag_clipping(row, fewest, noisy) for row in subject.rows])
    text = "{count:point is|points are} clipped at the end of the range"
    return _flag_result(subject, flags, text, limits["fail"])


HEIGHT_CHECKS = (
    Check(
        "dropouts",
        1,
        "Are heights missing?",
        "Gaps are interpolated, and the bands include the resulting error. Clean or "
        "coat the surface.",
        {
            "suspect": Limit(1e-3, "1", "single interpolated points do not change the spectrum"),
            "in_a_row": Limit(8.0, "1", "a longer gap removes waves of its length"),
            "fail": Limit(0.5, "1", "with less than half a scan, nothing is computed"),
            "stretch": Limit(
                0.05, "1", "a gap of this fraction of the length causes errors of some per cent"
            ),
        },
        _dropouts,
    ),
    Check(
        "steps",
        2,
        "Are there jumps in height between neighbouring points?",
        "Look for a slipping specimen, an edge or a scratch, and cut the scan there.",
        {
            "factor": Limit(12.0, "1", "slopes of ground and blasted surfaces reach 7"),
            "fail": Limit(1e-3, "1", "one jump may be an edge; one in a thousand points is not"),
        },
        _steps,
    ),
    Check(
        "clipping",
        3,
        "Does the profile reach the end of the gauge's range?",
        "Level the specimen or choose a larger range, and scan again.",
        {
            "points": Limit(8.0, "1", "by chance, a stylus has equal heights at some points"),
            "noisy": Limit(0.01, "1", "fewer points at the limit, scattered by noise, are summits"),
            "fail": Limit(0.01, "1", "clipping of 1 % changes Rq and the spectrum"),
        },
        _clipping,
    ),
)
