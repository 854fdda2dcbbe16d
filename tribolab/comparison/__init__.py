"""Comparison of results folders, history of instruments, and planning."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.comparison.instrument_history import history
    from tribolab.comparison.planning import measuring_plan
    from tribolab.comparison.repeat_study import repeatability

__all__ = [
    "history",
    "measuring_plan",
    "repeatability",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "history": "instrument_history",
        "measuring_plan": "planning",
        "repeatability": "repeat_study",
    },
)
