"""What a person decided on a run, put upon what its checks said: findings settled, samples marked.

A finding is settled where the run is accepted or rejected as a whole, or where every sample that
it objects to lies in segments that are. It stays to be read, and no longer counts. The samples of
these segments carry the bit ``manual``: of rejected ones the flag is "fail", of accepted ones
"good" in spite of the other bits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import pieces
from tribolab.arrays.scratch import room
from tribolab.friction.decisions.decide import DECISIONS
from tribolab.friction.decisions.decision import ACCEPT, REJECT
from tribolab.friction.decisions.rejected import rejected
from tribolab.qc.findings import Findings
from tribolab.qc.flags import FAIL, GOOD, MISSING, SUSPECT
from tribolab.qc.register import OBJECTIONS, Result

MANUAL, BIT = "manual", 26  # its name and bit in ``<variable>_qc_tests``, as of a check
_ACCEPTED, _REJECTED = "accepted", "rejected"


class _Heard(NamedTuple):
    """A decision as the samples hear it: what, by whom, on which pieces of the record."""

    action: str
    author: str
    pieces: tuple[slice, ...]


class _Reviewed(NamedTuple):
    """Samples of a run that a person accepted or rejected (rejecting wins), and who did."""

    accepted: np.ndarray
    rejected: np.ndarray
    decisions: tuple[_Heard, ...]

    def who(self, action: str, bad: np.ndarray) -> str:
        """Names of those whose decisions touch samples."""
        names = [
            heard.author
            for heard in self.decisions
            if heard.action == action and any(bad[piece].any() for piece in heard.pieces)
        ]
        return ", ".join(dict.fromkeys(names))


def reviewed(findings: Findings, segments: xr.Dataset) -> Findings:
    """Return findings in which a person's decisions are heard.

    Parameters
    ----------
    findings
        What the checks said.
    segments
        From `decide`; without decisions the findings come back as they are.
    """
    rows = segments.attrs.get(DECISIONS, [])
    if not any(row["action"] in (ACCEPT, REJECT) for row in rows):
        return findings
    flagged = findings.marked
    seen = _samples(flagged["time"].values, segments, rows)
    results = tuple((check, _settled(result, seen)) for check, result in findings.results)
    objecting = [r for _, r in results if r.status in OBJECTIONS]
    verdict = ""
    if seen.rejected.all() or (segments.sizes["segment"] and rejected(segments).all()):
        verdict = _REJECTED
    elif objecting and all(r.settled for r in objecting):
        verdict = _ACCEPTED if any(r.settled == _ACCEPTED for r in objecting) else ""
    return replace(findings, results=results, flagged=_marked(flagged, seen), verdict=verdict)


def _samples(
    time: np.ndarray, segments: xr.Dataset, rows: Sequence[Mapping[str, Any]]
) -> _Reviewed:
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
        decisions.append(_Heard(row["action"], row["author"], parts))
    return _Reviewed(masks[ACCEPT] & ~masks[REJECT], masks[REJECT], tuple(decisions))


def _settled(result: Result, seen: _Reviewed) -> Result:
    """Return a result with who settled it, if a person did."""
    if result.status not in OBJECTIONS:
        return result
    bad = np.ones(seen.accepted.size, dtype=bool)  # without flags it is about the whole run
    if result.flags is not None and (result.flags >= SUSPECT).any():
        bad = result.flags >= SUSPECT
    if seen.rejected[bad].all():
        return replace(result, settled=_REJECTED, settled_by=seen.who(REJECT, bad))
    if (seen.accepted | seen.rejected)[bad].all():
        return replace(result, settled=_ACCEPTED, settled_by=seen.who(ACCEPT, bad))
    return result


def _marked(flagged: xr.Dataset, seen: _Reviewed) -> xr.Dataset:
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
