"""Application of a person's decisions to the segments of a run."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from tribolab.core.attributes import SegmentAttributes
from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.untyped import Json
from tribolab.friction.decisions.bounds import set_bounds
from tribolab.friction.decisions.decision import ACCEPT, NEW_BOUNDS, NOTE, REJECT, Decision
from tribolab.friction.decisions.rejected import REJECTED, rejected
from tribolab.friction.zero.of_run import PAIRED
from tribolab.units.stamping import stamp

DECISIONS = "decisions"  # name of the attribute with all decisions and the segments they concern
# a decision concerns the segment that contains more than this share of its interval
_MORE_THAN = 0.5
_SHOWN = 3  # nearest segments listed in the message if a decision matches none
DECISION_WORDS = {REJECT: "rejected", ACCEPT: "accepted", NEW_BOUNDS: "new bounds", NOTE: "noted"}


def decide(
    segments: xr.Dataset, decisions: Decision | Iterable[Decision], run: xr.Dataset | None = None
) -> xr.Dataset:
    """Apply a person's decisions to segments: reject, accept, change bounds, note.

    Parameters
    ----------
    segments
        From `find_segments`; or a result of `friction_coefficient` whose zero is not from strokes.
    decisions
        One `Decision` or several; `load_review` reads them from a file.
    run
        The run of the segments; needed for new bounds only.

    Returns
    -------
    xarray.Dataset
        The same, with ``rejected`` (1 or 0) and ``decision`` (text, with the reason of a rejection)
        on dim ``segment``, and the attribute ``decisions``: a list of the decisions with the
        numbers of the ``segments`` that they concern, from 1. The time that a segment with new
        bounds no longer includes is ``omitted``. Without decisions the segments are unchanged.

    Raises
    ------
    AnalysisError
        If a decision finds no segment, two contradict each other, or new bounds are outside the run
        or in another segment.

    Notes
    -----
    A decision concerns the segment with more than half of its interval (there is at most one), so
    that it stays with its stroke if the bounds found change slightly. All decisions refer to the
    segments as found, independent of each other. New bounds are the ends of the segment before
    trimming.

    `friction_coefficient` takes no zero from rejected segments, and `measured_stribeck_curve` and
    `stick_slip_curve` leave them out. In a friction result a stroke cannot be rejected if the zero
    is from strokes: the friction of the other strokes depends on it.

    Examples
    --------
    >>> import xarray as xr
    >>> from tribolab.friction.decisions.decision import Decision
    >>> from tribolab.friction.segments.find import find_segments
    >>> v = np.repeat([0.0, 1e-3, 0.0, -1e-3, 0.0], 100)
    >>> run = xr.Dataset({"sliding_velocity": ("time", v)}, {"time": np.arange(500) / 10})
    >>> slipped = Decision("reject", "slipped off", "A. Person", "2026-11-20", "31 s", "39 s")
    >>> decided = decide(find_segments(run), slipped)
    >>> decided.rejected.values.tolist(), decided.decision.values.tolist()
    ([0, 1], ['', 'rejected by A. Person: slipped off'])
    """
    made = (decisions,) if isinstance(decisions, Decision) else tuple(decisions)
    if not made:
        return segments
    touched = [_affected_segments(segments, decision) for decision in made]
    _refuse_contradictions(segments, made, touched)
    result = segments.copy()
    for decision, places in zip(made, touched, strict=True):
        if decision.action == NEW_BOUNDS:
            result = set_bounds(result, places[0], decision, run)
    count = segments.sizes["segment"]
    out = rejected(segments)
    reasons: list[list[str]] = [[] for _ in range(count)]
    if "decision" in segments:
        reasons = [[text] if text else [] for text in segments["decision"].values]
    rows: list[Json] = list(segments.attrs.get(DECISIONS, []))
    for decision, places in zip(made, touched, strict=True):
        out[places] |= decision.action == REJECT
        # remarks on the whole run are not repeated for each segment, except the reason of rejection
        spoken = decision.interval is not None or decision.action == REJECT
        for place in places if spoken else ():
            reasons[place].append(
                f"{DECISION_WORDS[decision.action]} by {decision.author}: {decision.reason}"
            )
        rows.append(decision.plain() | {"segments": [place + 1 for place in places]})
    result[REJECTED] = "segment", out.astype(np.int8)
    result["decision"] = "segment", np.array(["; ".join(texts) for texts in reasons], dtype=object)
    return stamp(result).assign_attrs({DECISIONS: rows})


def remove_decisions(data: xr.Dataset) -> xr.Dataset:
    """Return segments, or their friction, without the variables and attribute added by `decide`.

    It undoes notes and acceptance; rejection and new bounds change numbers and cannot be undone.
    """
    bare = data.drop_vars([REJECTED, "decision"], errors="ignore")
    bare.attrs = {name: value for name, value in data.attrs.items() if name != DECISIONS}
    return bare


def _affected_segments(segments: xr.Dataset, decision: Decision) -> list[int]:
    """Return the indices of the segments that a decision concerns."""
    every = list(range(segments.sizes["segment"]))
    if decision.interval is None:
        places = every
    else:
        places = [_find_segment(segments, decision, *decision.interval)]
    if "omitted" in segments.dims or decision.action not in (REJECT, NEW_BOUNDS):
        return places
    # a friction result has no signals from which it could be computed again
    if decision.action == NEW_BOUNDS:
        raise _refused(segments, decision, "new bounds need the friction to be computed again")
    if len(places) < len(every) and SegmentAttributes.from_attrs(segments.attrs).offset in PAIRED:
        raise _refused(segments, decision, "the friction of the other strokes depends on it")
    return places


def _find_segment(segments: xr.Dataset, decision: Decision, low: float, high: float) -> int:
    """Return the index of the segment that contains more than half of a decision's interval."""
    start, stop = segments["start"].values, segments["stop"].values
    common = np.minimum(stop, high) - np.maximum(start, low)
    if common.size and common.max() > _MORE_THAN * (high - low):
        return int(common.argmax())
    what = f"{decision} finds no segment: none holds more than half of its interval"
    away = np.maximum(np.maximum(start - high, low - stop), 0.0)
    near = sorted(np.argsort(away, kind="stable")[:_SHOWN].tolist())
    listed = ", ".join(f"{n + 1} ({start[n]:.6g} to {stop[n]:.6g} s)" for n in near)
    what += f"; the nearest: {listed}" if near else "; the run has none"
    cure = Cure(
        notebook="correct its start and stop",
        campaign="correct its from and to in review.toml, or take it out",
    )
    raise AnalysisError(what, where=segments.attrs.get("source", ""), cure=cure)


def _refused(segments: xr.Dataset, decision: Decision, why: str) -> AnalysisError:
    cure = Cure(notebook="decide on the segments, and call friction_coefficient with them")
    what = f"{decision} cannot be applied to a friction result: {why}"
    return AnalysisError(what, where=segments.attrs.get("source", ""), cure=cure)


def _refuse_contradictions(
    segments: xr.Dataset, made: tuple[Decision, ...], touched: list[list[int]]
) -> None:
    """Raise if a segment is both accepted and rejected, or has two new bounds."""
    for number, decision in enumerate(made):
        for other, places in zip(made[:number], touched[:number], strict=True):
            common = set(places) & set(touched[number]) or decision.interval == other.interval
            actions = {decision.action, other.action}
            first, second = sorted((other, decision), key=lambda d: d.action)
            accepted_in_part = first.interval is None and second.interval is not None
            if not common or not (
                decision.action == other.action == NEW_BOUNDS
                or (actions == {ACCEPT, REJECT} and not accepted_in_part)
            ):
                continue
            cure = Cure(campaign="take one of them out of review.toml", notebook="take one out")
            what = f"{other} and {decision} contradict each other"
            raise AnalysisError(what, where=segments.attrs.get("source", ""), cure=cure)
