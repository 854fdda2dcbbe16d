"""Record of a person's decision on a run or segment, with reason, author and date."""

from __future__ import annotations

import datetime as dt
import math
from dataclasses import dataclass

from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.core.untyped import Json
from tribolab.units.conversion import to_si

REJECT, ACCEPT, NEW_BOUNDS, NOTE = "reject", "accept", "bounds", "note"
ACTIONS = (REJECT, ACCEPT, NEW_BOUNDS, NOTE)
_TIMES = ("start", "stop", "new_start", "new_stop")


@dataclass(frozen=True)
class Decision:
    """Decision of a person on a run, or on one of its segments, which a time interval identifies.

    Parameters
    ----------
    action
        ``"reject"``: exclude from curves. ``"accept"``: include in spite of objections of checks.
        ``"bounds"``: change the start or end of the segment. ``"note"``: a remark.
    reason
        Reason of the decision.
    author
        Person who decided.
    date
        Date, as ``"2026-11-20"``.
    start, stop
        Interval of the run's time [s] that identifies the segment; without it the whole run.
    new_start, new_stop
        New start and end of the segment [s] for ``"bounds"``: one of them or both.

    Examples
    --------
    >>> slipped = Decision("reject", "slipped off", "A. Person", "2026-11-20", "12.5 s", "0.5 min")
    >>> slipped.start, slipped.stop
    (12.5, 30.0)
    >>> print(slipped)
    reject, 12.5 to 30 s (A. Person, 2026-11-20)
    """

    action: str
    reason: str
    author: str
    date: str | dt.date
    start: float | None = None
    stop: float | None = None
    new_start: float | None = None
    new_stop: float | None = None

    def __post_init__(self) -> None:
        """Convert text to SI values and raise an error for invalid decisions."""
        if self.action not in ACTIONS:
            known = nearest(self.action, ACTIONS)
            raise AnalysisError(f"'{shown(self.action)}' is no decision{known}")
        for name in ("reason", "author"):
            if not getattr(self, name).strip():
                raise AnalysisError(f"a decision must state its {name}")
        object.__setattr__(self, "date", _day(self.date))
        for name in _TIMES:
            value = getattr(self, name)
            object.__setattr__(self, name, None if value is None else _seconds(value, name))
        self._refuse_times()

    @property
    def interval(self) -> tuple[float, float] | None:
        """Interval of the run's time [s] that identifies the segment; None for the whole run."""
        return None if self.start is None or self.stop is None else (self.start, self.stop)

    @property
    def moves_numbers(self) -> bool:
        """Whether the decision may change friction, as a rejection or new bounds do."""
        return self.action in (REJECT, NEW_BOUNDS)

    def __str__(self) -> str:
        """Return a short description of the decision."""
        where = "the whole run"
        if self.interval is not None:
            where = f"{self.interval[0]:.6g} to {self.interval[1]:.6g} s"
        return f"{self.action}, {where} ({shown(self.author)}, {self.date})"

    def plain(self) -> Json:
        """Return the decision as plain data for JSON, with units in the names."""
        facts: Json = {"action": self.action}
        facts |= {f"{name}_s": getattr(self, name) for name in _TIMES}
        return facts | {"reason": self.reason, "author": self.author, "date": str(self.date)}

    def _refuse_times(self) -> None:
        if (self.start is None) != (self.stop is None):
            raise AnalysisError("an interval wants both its ends, or none for the whole run")
        for low, high, what in (
            (self.start, self.stop, "the interval"),
            (self.new_start, self.new_stop, "the new interval"),
        ):
            if low is not None and high is not None and not low < high:
                raise AnalysisError(f"{what} ends at {high:g} s, not after it begins at {low:g} s")
        has_bounds = self.new_start is not None or self.new_stop is not None
        if has_bounds and self.action != NEW_BOUNDS:
            raise AnalysisError(f"only '{NEW_BOUNDS}' has new bounds, not '{self.action}'")
        if self.action == NEW_BOUNDS and (self.interval is None or not has_bounds):
            raise AnalysisError(
                f"'{NEW_BOUNDS}' wants the interval that tells the segment, and a new beginning or "
                "end"
            )


def _seconds(value: str | float, name: str) -> float:
    time = to_si(value, "s", name=name)
    if not math.isfinite(time):
        raise AnalysisError(f"{name}: {time} s is no time")
    return time


def _day(date: str | dt.date) -> str:
    try:
        return dt.date.fromisoformat(str(date)).isoformat()
    except ValueError as error:
        raise AnalysisError(
            f"'{shown(str(date))}' is no date; write year, month and day, e.g. '2026-11-20'"
        ) from error
