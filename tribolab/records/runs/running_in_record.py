"""Record of the running-in of a run for report.json, table and page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import number
from tribolab.friction.running_in.kinds import (
    CYCLES,
    NONE,
    NOT_FINISHED,
    RUN_IN,
    STEP,
    STRETCHES,
    STROKES,
)
from tribolab.records.annotations import Natural, means, one_of
from tribolab.records.parts import Row
from tribolab.records.wording import error_text

if TYPE_CHECKING:
    from tribolab.friction.points.mean_of_repeats import Mean

_MATTERS = 0.02  # relative change of friction; less is within the scatter of repeats
_COUNTED = "unit of averaging: cycles, single strokes, or intervals of equal duration"
_WEAR = "displacement normal to the contact, end minus beginning"


@dataclass(frozen=True)
class RunningIn:
    """Running-in and steady state of a run at one speed.

    Distances, times and numbers are counted from the beginning of sliding at this speed.
    """

    sliding_speed_m_s: float | None
    counted: Annotated[str, one_of(CYCLES, STROKES, STRETCHES, meaning=_COUNTED)]
    verdict: Annotated[str, one_of(NONE, RUN_IN, STEP, NOT_FINISHED)]
    values: Annotated[Natural, means("cycles, strokes or intervals")]
    start_m: Annotated[float | None, means("start of the steady part; null without a steady part")]
    start_U95_m: float | None
    start_s: float | None
    start_number: int | None
    stop_m: Annotated[
        float | None, means("end of the steady part; before the end of the run if friction changes")
    ]
    stop_s: float | None
    stop_number: int | None
    end_m: float | None
    end_s: float | None
    first_friction_coefficient: float | None
    last_friction_coefficient: float | None
    steady_friction_coefficient: float | None
    steady_friction_coefficient_sem: Annotated[
        float | None, means("standard error of the mean over the steady part, within the run")
    ]
    steady_friction_coefficient_U95: float | None
    mean_friction_coefficient: Annotated[float | None, means("mean over the whole run")]
    mean_friction_coefficient_U95: float | None
    more_than_exponential: Annotated[bool, means("whether a single exponential does not fit")]
    work_per_cycle_J: Annotated[
        float | None, means("mean over the steady part, or over the whole run")
    ]
    wear_depth_m: Annotated[float | None, means(_WEAR)]

    @property
    def is_unsteady(self) -> bool:
        """Whether the run never becomes steady, so that its mean depends on its length."""
        return self.verdict == NOT_FINISHED

    @property
    def error_of_mean(self) -> float | None:
        """Return U95 of the mean over the whole run; None if the mean depends on its length."""
        return None if self.changes else self.mean_friction_coefficient_U95

    @property
    def changes(self) -> bool:
        """Whether friction changes significantly along the run."""
        return self._moves(self.first_friction_coefficient) or self._changes_at_end

    @property
    def _changes_at_end(self) -> bool:
        early = self.stop_m is not None and self.end_m is not None and self.stop_m < self.end_m
        return early and self._moves(self.last_friction_coefficient)

    def _moves(self, end: float | None) -> bool:
        settled = self.steady_friction_coefficient
        if self.verdict == NOT_FINISHED:
            settled = self.last_friction_coefficient
        if self.verdict == NONE and not (self.stop_m is not None and self.stop_m != self.end_m):
            return False
        if settled is None or end is None:
            return False
        return abs(end - settled) > _MATTERS * abs(settled)

    @property
    def text(self) -> str:
        """Return text on the running-in; "" if friction does not change."""
        if not self.changes:
            return ""
        first, last = self.first_friction_coefficient, self.last_friction_coefficient
        steady = self.steady_friction_coefficient
        whole = length_text(self.end_m)
        if self.verdict == NOT_FINISHED:
            return (
                f"friction {_verb(first, last)} along the run, from {number(first or 0.0)} to "
                f"{number(last or 0.0)} over {whole}, and does not become steady. Its mean depends "
                "on the length of the run"
            )
        text = error_text(steady, self.steady_friction_coefficient_U95)
        parts = []
        if self._moves(first):
            parts.append(
                f"friction {_verb(first, steady)} along the run in its first "
                f"{length_text(self.start_m)} of {whole}, from {number(first or 0.0)} to {text}"
            )
        if self._changes_at_end:
            begin = "and" if parts else f"friction {_verb(steady, last)} along the run:"
            parts.append(
                f"{begin} from {length_text(self.stop_m)} of {whole} on from {text} to "
                f"{number(last or 0.0)}"
            )
        mean = number(self.mean_friction_coefficient or 0.0)
        cure = 'To exclude the running-in from all tables, set steady = "auto" in [segments]'
        return f"{' '.join(parts)}; the mean over the whole run is {mean}. {cure}"

    def row(self) -> Row:
        """Return the running-in as a row of a table."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


def steady_levels(runs: Mapping[str, Sequence[RunningIn]]) -> dict[str, float]:
    """Return the steady friction of runs at one speed, by name; {} unless all become steady."""
    levels = {}
    for name, rows in runs.items():
        steady = rows[0].steady_friction_coefficient if len(rows) == 1 else None
        if steady is None or steady <= 0:
            return {}
        levels[name] = steady
    return levels


def mean_of_steady(rows: Sequence[RunningIn]) -> Mean | None:
    """Return the mean steady friction of repeats; None unless every run becomes steady.

    U95 is that of the scatter between repeats, and at least that within the runs.
    """
    # imported late for a quick start
    from tribolab.friction.points.mean_of_repeats import Mean, mean_of_repeats

    levels = [row.steady_friction_coefficient for row in rows]
    if None in levels or not levels:
        return None
    values = np.array(levels, float)
    own = [row.steady_friction_coefficient_U95 or 0.0 for row in rows]
    within = float(np.linalg.norm(own)) / values.size  # repeats count equally
    if values.size < 2:
        return Mean(float(values[0]), within / NORMAL, within)
    found = mean_of_repeats(values, np.full(values.size, np.nan))
    return found._replace(u95=max(found.u95, within))


def _verb(before: float | None, after: float | None) -> str:
    return "rises" if abs(after or 0.0) > abs(before or 0.0) else "falls"


def length_text(metres: float | None) -> str:
    """Return a sliding distance as text.

    Examples
    --------
    >>> length_text(172.3), length_text(0.0124)
    ('172 m', '12.4 mm')
    """
    if metres is None:
        return "–"
    return f"{number(metres)} m" if abs(metres) >= 1 else f"{number(1e3 * metres)} mm"
