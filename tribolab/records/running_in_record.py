"""Running-in of a run as report.json, its table and the page have it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
import xarray as xr

from tribolab.friction.running_in.history import CYCLES, STRETCHES, STROKES, History, histories_of
from tribolab.friction.running_in.settling import NONE, NOT_FINISHED, RUN_IN, STEP, blocks_of
from tribolab.records.annotations import Natural, means, one_of
from tribolab.records.parts import Row
from tribolab.records.wording import NORMAL, plain_value, with_error
from tribolab.words import number

_MOST_POINTS = 384  # of the course that figures draw
_MATTERS = 0.02  # change of friction over its mean: repeats scatter as much
_COUNTED = "what friction is averaged over: cycles, single strokes, or stretches of equal time"
_WEAR = "displacement normal to the contact at the end, from that at the beginning"


@dataclass(frozen=True)
class RunningIn:
    """Running-in and steady state of a run at one speed.

    Distances, times and numbers are counted from the beginning of sliding at this speed.
    """

    sliding_speed_m_s: float | None
    counted: Annotated[str, one_of(CYCLES, STROKES, STRETCHES, meaning=_COUNTED)]
    verdict: Annotated[str, one_of(NONE, RUN_IN, STEP, NOT_FINISHED)]
    values: Annotated[Natural, means("cycles, strokes or stretches")]
    start_m: Annotated[float | None, means("where the steady part starts; null without one")]
    start_U95_m: float | None
    start_s: float | None
    start_number: int | None
    stop_m: Annotated[float | None, means("where it stops: before the end if friction changes")]
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
    more_than_exponential: Annotated[bool, means("whether one exponential does not describe it")]
    work_per_cycle_J: Annotated[float | None, means("mean over the steady part, else over all")]
    wear_depth_m: Annotated[float | None, means(_WEAR)]

    @property
    def is_unsteady(self) -> bool:
        """Whether the run never becomes steady: its mean depends on its length."""
        return self.verdict == NOT_FINISHED

    @property
    def changes(self) -> bool:
        """Whether friction changes along the run by as much as matters."""
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
        """What a reader has to know; "" if friction does not change."""
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
        said = with_error(steady, self.steady_friction_coefficient_U95)
        parts = []
        if self._moves(first):
            parts.append(
                f"friction {_verb(first, steady)} along the run in its first "
                f"{length_text(self.start_m)} of {whole}, from {number(first or 0.0)} to {said}"
            )
        if self._changes_at_end:
            begin = "and" if parts else f"friction {_verb(steady, last)} along the run:"
            parts.append(
                f"{begin} from {length_text(self.stop_m)} of {whole} on from {said} to "
                f"{number(last or 0.0)}"
            )
        mean = number(self.mean_friction_coefficient or 0.0)
        cure = 'State steady = "auto" in [segments] to leave the rest out'
        return f"{' '.join(parts)}; the mean over all is {mean}. {cure}"

    def row(self) -> Row:
        """Return it as a row of a table."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


def _verb(before: float | None, after: float | None) -> str:
    return "rises" if abs(after or 0.0) > abs(before or 0.0) else "falls"


def length_text(metres: float | None) -> str:
    """Return a sliding distance in words.

    Examples
    --------
    >>> length_text(172.3), length_text(0.0124)
    ('172 m', '12.4 mm')
    """
    if metres is None:
        return "–"
    return f"{number(metres)} m" if abs(metres) >= 1 else f"{number(1e3 * metres)} mm"


def running_in_of(
    run: xr.Dataset, friction: xr.Dataset
) -> tuple[tuple[RunningIn, ...], tuple[Row, ...]]:
    """Return the running-in of a run at each speed, and the courses that figures draw.

    Parameters
    ----------
    run, friction
        A run (time) and its friction (segment).

    Returns
    -------
    tuple
        A record for each speed at which the run slides long enough; rows with
        ``sliding_speed_m_s``, ``number`` (of the cycle or stretch, from 1), ``time_s``,
        ``distance_m``, ``friction_coefficient`` and ``wear_depth_m``, at most 384 of each speed.
    """
    histories = histories_of(run, friction)
    rows = [row for history in histories for row in _course(history)]
    return tuple(map(recorded, histories)), tuple(rows)


def _course(history: History) -> list[Row]:
    count = history.friction.size
    columns = {
        "number": np.arange(1.0, count + 1),
        "time_s": history.time,
        "distance_m": history.distance,
        "friction_coefficient": history.friction,
        "wear_depth_m": history.wear,
    }
    blocks = {name: blocks_of(of, _MOST_POINTS).tolist() for name, of in columns.items() if of.size}
    speed = {"sliding_speed_m_s": plain_value(history.speed)}
    names = list(blocks)
    return [
        speed | dict(zip(names, plain_value(row), strict=True))
        for row in zip(*blocks.values(), strict=True)
    ]


def recorded(history: History) -> RunningIn:
    """Return the record of a history."""
    settling, count = history.settling, history.friction.size
    start_m, stop_m, end_m = history.places(history.distance)
    start_s, stop_s, end_s = history.places(history.time)
    zero = 1.5 * history.time[0] - history.time[1] / 2
    steady = slice(settling.start, settling.stop) if settling.is_steady else slice(None)
    first, last = (settling.start + 1, settling.stop) if settling.is_steady else (None, None)
    work, wear = history.work[steady], history.wear
    return RunningIn(
        sliding_speed_m_s=plain_value(history.speed),
        counted=history.counted,
        verdict=settling.kind,
        values=count,
        start_m=plain_value(start_m),
        start_U95_m=plain_value(NORMAL * settling.start_u * end_m / count),
        start_s=plain_value(start_s - zero),
        start_number=first,
        stop_m=plain_value(stop_m),
        stop_s=plain_value(stop_s - zero),
        stop_number=last,
        end_m=plain_value(end_m),
        end_s=plain_value(end_s - zero),
        first_friction_coefficient=plain_value(settling.first),
        last_friction_coefficient=plain_value(history.friction[-max(count // 10, 1) :].mean()),
        steady_friction_coefficient=plain_value(history.steady.value),
        steady_friction_coefficient_sem=plain_value(history.steady.sem),
        steady_friction_coefficient_U95=plain_value(history.steady.u95),
        mean_friction_coefficient=plain_value(history.overall.value),
        mean_friction_coefficient_U95=plain_value(history.overall.u95),
        more_than_exponential=settling.more,
        work_per_cycle_J=plain_value(work.mean()) if work.size else None,
        wear_depth_m=plain_value(wear[-1]) if wear.size else None,
    )
