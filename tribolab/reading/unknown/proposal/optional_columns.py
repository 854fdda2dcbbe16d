"""A doubt blocks only what needs it: doubtful columns that no result needs are left out."""

from __future__ import annotations

from typing import TypeVar

from tribolab.core.errors import shown
from tribolab.reading.unknown.model import DraftColumn
from tribolab.reading.unknown.proposal.model import Drafted

AnyDraft = TypeVar("AnyDraft", bound=Drafted)
_FORCES = {"friction_force", "shear_stress", "normal_force", "normal_stress", "set_normal_force"}
_MOTION = {"position", "rotation_speed", "set_speed", "rolling_speed", "slide_roll_ratio"}


def leave_out_doubtful(draft: AnyDraft) -> tuple[AnyDraft, tuple[str, ...]]:
    """Return a draft of a run without doubtful columns that no result needs, and what they are.

    Friction, load and speed may each be certain from one column: then no other column of them is
    needed. A time is always needed.
    """
    understood = draft.understood
    if understood is None or draft.kind != "run":
        return draft, ()
    certain = {c.quantity for c in understood.columns if c.used and not _is_doubtful(c)}
    out = [c for c in understood.columns if _is_doubtful(c) and not _is_needed(c.quantity, certain)]
    if not out:
        return draft, ()
    columns = [
        c._replace(used=False, guessed=(), options=(), fill_in="", note=f"left out: {_doubt_of(c)}")
        if c in out
        else c
        for c in understood.columns
    ]
    left = tuple(f"'{shown(c.label, 30)}' ({_doubt_of(c)})" for c in out)
    return draft.with_understood(understood._replace(columns=tuple(columns))), left


def _is_doubtful(column: DraftColumn) -> bool:
    return bool(column.guessed or column.fill_in)


def _is_needed(quantity: str | None, certain: set[str | None]) -> bool:
    """Whether a result would be a guess with this quantity, or missing without it."""
    if quantity in _FORCES:
        return "friction_coefficient" not in certain
    if quantity in _MOTION:
        return "sliding_velocity" not in certain
    if quantity == "friction_coefficient":
        return not {"friction_force", "normal_force"} <= certain
    return quantity in (None, "time", "sliding_velocity", "step", "cycle")


def _doubt_of(column: DraftColumn) -> str:
    if column.guessed:
        others = f", or {', '.join(column.options)}" if column.options else ""
        return f"{'; '.join(column.guessed)}{others}"
    return f"{column.quantity}, unit not stated"
