"""Record of a run's running-in, and friction along the run for figures."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.friction.running_in.history import History, histories_of
from tribolab.friction.running_in.settling import blocks_of
from tribolab.records.parts import Row
from tribolab.records.runs.running_in_record import RunningIn
from tribolab.records.wording import plain_value

_MAX_POINTS = 384  # columns of friction along a run for figures


def running_in_of(
    run: xr.Dataset, friction: xr.Dataset
) -> tuple[tuple[RunningIn, ...], tuple[Row, ...]]:
    """Return the running-in of a run at each speed, and friction along the run for figures.

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
    blocks = {name: blocks_of(of, _MAX_POINTS).tolist() for name, of in columns.items() if of.size}
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
