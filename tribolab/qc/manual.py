"""Decisions of the user, applied to the findings and flags of a run.

A finding is settled if the whole run, or all segments with the samples it objects to, are accepted
or rejected. It is still listed but no longer counts. The samples of these segments carry the bit
``manual``; their flag is "fail" if rejected and "good" if accepted, whatever the other bits are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.arrays.scratch import room
from tribolab.friction.decisions.decided_segments import DECISIONS
from tribolab.friction.decisions.decision import ACCEPT, REJECT
from tribolab.friction.decisions.rejected import rejected
from tribolab.qc.findings import Findings
from tribolab.qc.flags import FAIL, GOOD, MISSING, SUSPECT
from tribolab.qc.register import OBJECTIONS, Result

MANUAL, BIT = "manual", 26  # name, and bit in ``<variable>_qc_tests``, like those of a check
_ACCEPTED, _REJECTED = "accepted", "rejected"


class _Decision(NamedTuple):
    """User's decision on samples: action, author, and index ranges of the samples."""

    action: str
    author: str
    pieces: tuple[slice, ...]


class _DecidedSamples(NamedTuple):
    """Masks of accepted and rejected samples (rejection prevails), and the decisions."""

    accepted: np.ndarray
    rejected: np.ndarray
    decisions: tuple[_Decision, ...]

    def who(self, action: str, bad: np.ndarray) -> str:
        """Return the authors of the decisions that cover the marked samples."""
        names = [
            one.author
            for one in self.decisions
            if one.action == action and any(bad[piece].any() for piece in one.pieces)
        ]
        return ", ".join(dict.fromkeys(names))


def apply_decisions(findings: Findings, segments: xr.Dataset) -> Findings:
    """Return the findings with the user's decisions applied.

    Parameters
    ----------
    findings
        Results of the checks.
    segments
        From `decide`; without decisions the findings are returned unchanged.
    """
    rows = segments.attrs.get(DECISIONS, [])
    if not any(row["action"] in (ACCEPT, REJECT) for row in rows):
        return findings
    flagged = findings.marked
    seen = _samples(flagged["time"].values, segments, rows)
    results = tuple((check, _settle(result, seen)) for check, result in findings.results)
    objecting = [r for _, r in results if r.status in OBJECTIONS]
    verdict = ""
    if seen.rejected.all() or (segments.sizes["segment"] and rejected(segments).all()):
        verdict = _REJECTED
    elif objecting and all(r.settled for r in objecting):
        verdict = _ACCEPTED if any(r.settled == _ACCEPTED for r in objecting) else ""
    return replace(findings, results=results, flagged=_mark_samples(flagged, seen), verdict=verdict)


def _samples(
    time: np.ndarray, segments: xr.Dataset, rows: Sequence[Mapping[str, Any]]
) -> _DecidedSamples:
    masks = {action: np.zeros(time.size, dtype=bool) for action in (ACCEPT, REJECT)}
    decisions = []
    first = np.searchsorted(time, segments["start"].values, "left")
    last = np.searchsorted(time, segments["stop"].values, "right")
    for row in rows:
        if row["action"] not in masks:
            continue
        parts = tuple(slice(first[n - 1], last[n - 1]) for n in row["segments"])
        if row["start_s"] is None:
            parts = (slice(None),)
        for part in parts:
            masks[row["action"]][part] = True
        decisions.append(_Decision(row["action"], row["author"], parts))
    return _DecidedSamples(masks[ACCEPT] & ~masks[REJECT], masks[REJECT], tuple(decisions))


def _settle(result: Result, seen: _DecidedSamples) -> Result:
    """Return a result with the decision that settles it, if any."""
    if result.status not in OBJECTIONS:
        return result
    bad = np.ones(seen.accepted.size, dtype=bool)  # without flags, a result concerns the whole run
    if result.flags is not None and (result.flags >= SUSPECT).any():
        bad = result.flags >= SUSPECT
    if seen.rejected[bad].all():
        return replace(result, settled=_REJECTED, settled_by=seen.who(REJECT, bad))
    if (seen.accepted | seen.rejected)[bad].all():
        return replace(result, settled=_ACCEPTED, settled_by=seen.who(ACCEPT, bad))
    return result


def _mark_samples(flagged: xr.Dataset, seen: _DecidedSamples) -> xr.Dataset:
    result = flagged.copy()
    decided = seen.accepted | seen.rejected
    for name in [str(n) for n in flagged.data_vars if f"{n}_qc" in flagged]:
        severity, tests = flagged[f"{name}_qc"], flagged[f"{name}_qc_tests"]
        values, mask = room(decided.size, np.int8), room(decided.size, np.int32)
        for first, last in pieces(0, decided.size):
            part = slice(first, last)
            flags, bits = severity.values[part], tests.values[part]
            objected = (flags == SUSPECT) | (flags == FAIL)
            flags = np.where(seen.accepted[part] & objected, np.int8(GOOD), flags)
            values[part] = np.where(seen.rejected[part] & (flags != MISSING), np.int8(FAIL), flags)
            mask[part] = np.where(decided[part], bits | np.int32(1 << BIT), bits)
        result[f"{name}_qc"] = severity.copy(data=values)
        result[f"{name}_qc_tests"] = tests.copy(data=mask)
    return result
