"""Decisions on a run and their consequences, a row for each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from tribolab.core.wording import many
from tribolab.friction.decisions.decided_segments import DECISION_WORDS, DECISIONS
from tribolab.friction.decisions.decision import Decision
from tribolab.friction.decisions.rejected import rejected
from tribolab.qc.register import OBJECTIONS
from tribolab.records.parts import Notice
from tribolab.records.runs.run_record import DecisionRow
from tribolab.records.wording import plain_value

_NOT_APPLIED = "not applied: the run failed"


def decision_rows(
    friction: xr.Dataset, as_found: xr.Dataset, checks: Sequence[Mapping[str, Any]]
) -> tuple[DecisionRow, ...]:
    """Return decisions on a run and their consequences, a row for each.

    Parameters
    ----------
    friction, as_found
        Results of `friction_coefficient` with the decisions and without.
    checks
        Rows of the findings.
    """
    return tuple(
        DecisionRow(
            **{key: value for key, value in decision.items() if key != "segments"},
            segments=tuple(decision["segments"]),
            effect=_effect(decision, friction, as_found, checks),
            friction_coefficient=_mean(friction, decision["segments"]),
            friction_coefficient_as_found=_mean(as_found, decision["segments"]),
        )
        for decision in friction.attrs.get(DECISIONS, [])
    )


def unapplied_decisions(decisions: Iterable[Decision]) -> tuple[DecisionRow, ...]:
    """Return the decisions on a run that failed."""
    return tuple(DecisionRow(**decision.plain(), effect=_NOT_APPLIED) for decision in decisions)


def decision_notices(run: str, rows: Sequence[DecisionRow]) -> list[Notice]:
    """Return notices for the reader on the decisions on a run."""
    return [
        Notice(
            "note",
            run,
            "decision",
            f"{row.where}: {DECISION_WORDS[row.action]} by {row.author} ({row.date}): {row.reason}"
            + (f" [{row.effect}]" if row.effect else ""),
        )
        for row in rows
    ]


def _effect(
    decision: Mapping[str, Any],
    friction: xr.Dataset,
    as_found: xr.Dataset,
    checks: Sequence[Mapping[str, Any]],
) -> str:
    count, action = len(decision["segments"]), decision["action"]
    if action == "reject":
        return f"{many(count, 'segment')} rejected"
    if action == "accept":
        return _accepted_checks(decision, checks)
    if action == "bounds":
        place = decision["segments"][0] - 1
        new, old = (
            f"{data['start'].values[place]:.6g} to {data['stop'].values[place]:.6g} s"
            for data in (friction, as_found)
        )
        return f"{new} instead of {old}"
    return ""


def _accepted_checks(decision: Mapping[str, Any], checks: Sequence[Mapping[str, Any]]) -> str:
    """Return, as text, the failed checks that an acceptance overruled."""
    decided = [(row["check"], str(row.get("decision", ""))) for row in checks]
    by = f", {decision['author']}, "  # authors of this decision
    names = [
        check
        for check, text in decided
        if text.startswith("accepted by ")
        and by in f", {text.removeprefix('accepted by ').removesuffix(' in spite of')}, "
    ]
    if names:
        return f"in spite of {', '.join(dict.fromkeys(names))}"
    objected = any(row["status"] in OBJECTIONS for row in checks)
    return "no objection lies in it alone" if objected else "nothing objects"


def _mean(friction: xr.Dataset, numbers: Sequence[int]) -> float | None:
    """Return the mean friction coefficient of the segments that are not rejected."""
    if "friction_coefficient" not in friction:
        return None
    out = rejected(friction)
    places = [number - 1 for number in numbers if not out[number - 1]]
    values = friction["friction_coefficient"].values[places]
    values = values[np.isfinite(values)]
    return plain_value(float(values.mean())) if values.size else None
