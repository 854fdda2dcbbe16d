"""Verdict on a campaign in one word, with counts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from tribolab.core.wording import many

if TYPE_CHECKING:
    from tribolab.records.parts import RunOutcome, SurfaceOutcome

OK, SUSPECT, CHECK, FAIL = "OK", "SUSPECT", "CHECK", "FAIL"
_BAD = ("fail", "error", "rejected")


class Verdict(NamedTuple):
    """Verdict OK, SUSPECT, CHECK (some unusable) or FAIL (all unusable), with counts."""

    word: str
    counts: str


def is_usable(run: RunOutcome) -> bool:
    """Whether a run is used in the curves: readable, sliding, and not rejected."""
    return run.done and bool(run.segments) and run.quality not in _BAD


def verdict_of(runs: Sequence[RunOutcome], surfaces: Sequence[SurfaceOutcome]) -> Verdict:
    """Verdict on a campaign.

    Parameters
    ----------
    runs, surfaces
        Their outcomes.
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
    elif any(run.quality == "suspect" for run in runs) or any(
        "suspect" in surface.objections for surface in scanned
    ):
        word = SUSPECT
    else:
        word = OK
    return Verdict(word, ", ".join(counts))
