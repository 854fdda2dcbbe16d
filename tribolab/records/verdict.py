"""Verdict on a campaign in one word, with counts."""

from __future__ import annotations

import statistics
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from tribolab.core.wording import many, percent, signed_percent
from tribolab.friction.segments.limits import RAMP_SHARE

if TYPE_CHECKING:
    from tribolab.records.parts import RunOutcome, SurfaceOutcome

OK, SUSPECT, CHECK, FAIL = "OK", "SUSPECT", "CHECK", "FAIL"
MEANINGS = {
    OK: "",
    SUSPECT: "usable, with doubts",
    CHECK: "partly usable",
    FAIL: "nothing usable",
}
_BAD = ("fail", "error", "rejected")
_MAX_NAMED = 2  # uncertain conditions that are named
_UNCERTAIN = 0.25  # relative U95 of a mean, above which only one digit is certain


class Verdict(NamedTuple):
    """Verdict OK, SUSPECT, CHECK (some unusable) or FAIL (all unusable), with counts."""

    word: str
    counts: str


def is_usable(run: RunOutcome) -> bool:
    """Return whether a run is usable: read, sliding, and not rejected by a check or person."""
    return run.done and (bool(run.segments) or run.ramp) and run.quality not in _BAD


def is_ramp(run: Mapping[str, Any]) -> bool:
    """Return whether the speed of a run rises or falls for most of it, so that it has no segment.

    Examples
    --------
    >>> ramp = {"reason": "ramp", "duration_s": 9.0}
    >>> is_ramp({"segments_found": 0, "omitted": [ramp], "duration_s": 10.0})
    True
    """
    parts = [part for part in run.get("omitted", ()) if part["reason"] == "ramp"]
    ramp = sum(part["duration_s"] or 0.0 for part in parts)
    return not run["segments_found"] and ramp > RAMP_SHARE.value * (run.get("duration_s") or 0.0)


def contradicts_repeats(checks: Iterable[Mapping[str, Any]]) -> bool:
    """Return whether a run contradicts its repeats, and nobody decided on it."""
    return any(row["check"] == "repeats" and not row["decision"] for row in checks)


def has_unknown_zero(checks: Iterable[Mapping[str, Any]]) -> bool:
    """Return whether the zero of the friction force is in doubt: then U95 does not include it."""
    return any(row["check"] == "zero_reference" and row["status"] == "suspect" for row in checks)


def uncertain_mean(points: Iterable[Mapping[str, Any]]) -> float | None:
    """Return the relative U95 of a mean of repeats (median of all speeds); None if small.

    Examples
    --------
    >>> point = {"runs": 3, "friction_coefficient": 0.5, "friction_coefficient_U95": 0.25}
    >>> uncertain_mean([point]), uncertain_mean([point | {"runs": 1}])
    (0.5, None)
    """
    shares = sorted(
        point["friction_coefficient_U95"] / abs(point["friction_coefficient"])
        for point in points
        if point["runs"] > 1 and point["friction_coefficient"]
        if point["friction_coefficient_U95"] is not None
    )
    usual = shares[len(shares) // 2] if shares else 0.0
    return usual if usual > _UNCERTAIN else None


def furthest_repeat(levels: Mapping[str, float | None], odd: Collection[str] = ()) -> str:
    """Return which repeat differs most from the median; "" if it is odd or there are only two.

    Examples
    --------
    >>> furthest_repeat({"a": 0.31, "b": 0.33, "c": 0.42})
    ' (c differs most, by +27 % from the median)'
    """
    known = {name: level for name, level in levels.items() if level}
    if len(known) < 3:
        return ""
    middle = statistics.median(known.values())
    name = max(known, key=lambda name: abs(known[name] / middle - 1))
    if name in odd:
        return ""
    by = signed_percent(known[name] / middle - 1)
    return f" ({name} differs most, by {by} from the median)"


def uncertain_words(conditions: Sequence[tuple[float, str]]) -> str:
    """Return a doubt about conditions, each with its result of `uncertain_mean` and its name."""
    worst = sorted(conditions, reverse=True)
    named = "; ".join(name for _, name in worst[:_MAX_NAMED])
    more = f"; and {len(worst) - _MAX_NAMED} more" if len(worst) > _MAX_NAMED else ""
    limit = percent(_UNCERTAIN)
    return f"the repeats disagree: U95 of their mean exceeds {limit} of the mean: {named}{more}"


def verdict_of(
    runs: Sequence[RunOutcome], surfaces: Sequence[SurfaceOutcome], *, uncertain: bool = False
) -> Verdict:
    """Return the verdict on a campaign.

    Parameters
    ----------
    runs, surfaces
        Outcomes of the runs and surfaces.
    uncertain
        Whether the repeats of a condition leave their mean uncertain.
    """
    scanned = [surface for surface in surfaces if surface.files]
    usable = [run for run in runs if is_usable(run)]
    computed = [surface for surface in scanned if surface.done]
    counts = []
    if runs:
        counts.append(f"{len(usable)} of {many(len(runs), 'run')} usable")
    if scanned:
        scans = many(sum(len(surface.files) for surface in scanned), "scan")
        counts.append(f"{scans} of {many(len(scanned), 'surface')}")
    bad = len(usable) < len(runs) or len(computed) < len(scanned)
    bad = bad or any({"fail", "error"} & set(surface.objections) for surface in scanned)
    if not usable and not computed:
        word = FAIL
    elif bad:
        word = CHECK
    elif (
        uncertain
        or any(run.quality == "suspect" for run in runs)
        or any("suspect" in surface.objections for surface in scanned)
    ):
        word = SUSPECT
    else:
        word = OK
    return Verdict(word, ", ".join(counts))
