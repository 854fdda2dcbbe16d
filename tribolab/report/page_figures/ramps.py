"""Figure of friction against speed in speed ramps: runs without intervals of constant speed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.wording import force_text, many
from tribolab.figures.signals import LOOKED_AT, main_signal
from tribolab.figures.spec import Axis, FigureSpec, KeyRow, KeyTable, Panel, Series
from tribolab.friction.points.mean_of_repeats import mean_of_repeats
from tribolab.records.parts import BAD, RunOutcome
from tribolab.records.wording import error_text
from tribolab.report.plain import plain_speed

MAX_RUNS = 8
_SPEEDS = "sliding_velocity", "set_speed"
_BINS_PER_DECADE = 12
_MIN_SAMPLES = 5  # fewest samples in a bin of speed
_MIN_DECADES = 0.3
_HEADS = "Ramp", "Mean load", "Speeds", "Highest µ ± U95", "Lowest µ ± U95"
_SMOOTHED = 50  # number of intervals whose mean speeds show where the speed of a run rises


class _Leg(NamedTuple):
    """Rising or falling part of a speed ramp: its points as a series, and its mean load [N]."""

    series: Series
    load: float | None


def has_ramps(run: RunOutcome) -> bool:
    """Whether a run may consist of speed ramps only, because it has no segment."""
    return run.done and run.segments == 0 and run.quality not in BAD


def ramp_specs(runs: Sequence[RunOutcome], folder: Path) -> list[FigureSpec]:
    """Return a figure of friction against instantaneous speed; empty without speed ramps.

    Parameters
    ----------
    runs
        Outcomes of the runs.
    folder
        The results folder with their data files.
    """
    legs = [
        leg for place, run in enumerate(runs) for leg in _legs(run, place, folder / run.data_file)
    ]
    series = [leg.series for leg in legs]
    both = any(drawn.open for drawn in series) and not all(drawn.open for drawn in series)
    if not series:
        return []
    return [
        FigureSpec(
            id="ramps",
            section="view-ramp",
            title="Friction vs. speed, ramps",
            note="Points: means over small ranges of speed; bars: standard deviations."
            + " Filled: the speed rises; open: it falls." * both
            + " The zero of the friction force is not removed.",
            alt=f"Friction over the instantaneous speed of {many(len(runs), 'run')}.",
            panels=(
                Panel(Axis("sliding speed v", "m/s", log=True), Axis("friction coefficient µ")),
            ),
            series=tuple(series),
            width="whole",
            height=430,
            numbers=_numbers(legs),
        )
    ]


def _numbers(legs: Sequence[_Leg]) -> KeyTable:
    """Return a table of highest and lowest µ: means of repeated ramps first, then each ramp."""
    groups: dict[tuple[str, str, bool, float | None], list[_Leg]] = {}
    for leg in legs:
        drawn = leg.series
        load = None if leg.load is None else float(f"{leg.load:.2g}")
        groups.setdefault((drawn.surface, drawn.medium, drawn.open, load), []).append(leg)
    means = [_row(f"mean of {len(group)} ramps", group) for group in groups.values() if group[1:]]
    return KeyTable(_HEADS, (*means, *(_row(leg.series.label, [leg]) for leg in legs)))


def _row(name: str, legs: Sequence[_Leg]) -> KeyRow:
    """Return a row with load, range of speed, highest and lowest µ; means if several ramps."""
    first = legs[0].series
    loads = [leg.load for leg in legs if leg.load is not None]
    speeds = [x for leg in legs for x in leg.series.x]
    cells = [name, force_text(float(np.mean(loads)) if loads else None)]
    cells.append(f"{plain_speed(min(speeds))} to {plain_speed(max(speeds))}")
    for extreme in (np.argmax, np.argmin):
        places = [int(extreme(leg.series.y)) for leg in legs]
        mu = np.array([leg.series.y[k] for leg, k in zip(legs, places, strict=True)])
        at = np.array([leg.series.x[k] for leg, k in zip(legs, places, strict=True)])
        several = mean_of_repeats(mu, np.full(mu.size, np.nan)) if mu.size > 1 else None
        text = error_text(float(mu.mean()), several.u95 if several else None)
        cells.append(f"{text} at {plain_speed(float(np.exp(np.log(at).mean())))}")
    return KeyRow(tuple(cells), first.surface, first.medium)


def _legs(run: RunOutcome, place: int, file: Path) -> list[_Leg]:
    """Return the rising and the falling part of a run, averaged in bins of speed."""
    # imported late for a quick start
    from tribolab.reading.netcdf.netcdf import read_groups

    groups = read_groups(file, ("run", "friction"), only={"run": (*LOOKED_AT, *_SPEEDS)})
    signals, friction = groups.values()
    name = next((n for n in _SPEEDS if n in signals), "")
    if not name or not ({"friction_coefficient", "normal_force"} & set(signals)):
        return []
    velocity = np.asarray(signals[name], float)
    speed = np.abs(velocity)
    mu = np.asarray(main_signal(signals, friction).values, float) * np.where(velocity < 0, -1, 1)
    known = np.isfinite(mu) & (speed > 0)
    if not known.any():
        return []
    low, high = np.percentile(speed[known], (1, 99))
    decades = float(np.log10(high / low))
    if decades < _MIN_DECADES:
        return []
    edges = np.geomspace(low, high, 1 + int(np.ceil(_BINS_PER_DECADE * decades)))
    rising = _rising(speed)
    drawn = []
    for leg, words in ((rising, "rising"), (~rising, "falling")):
        x, mean, spread = _binned(speed[known & leg], mu[known & leg], edges)
        if x:
            load = signals.get("normal_force")
            force = np.nan if load is None else float(np.abs(load.values)[known & leg].mean())
            series = Series(
                f"{run.name}, {words}",
                x,
                mean,
                style="points",
                colour=place,
                error=spread,
                pale=True,
                surface=run.surface,
                medium=run.medium,
                runs=(run.name,),
                link=(run.name,),
                open=words == "falling",
                joined=True,
            )
            drawn.append(_Leg(series, force if np.isfinite(force) else None))
    return drawn


def _rising(speed: np.ndarray) -> np.ndarray:
    """Return a mask of samples at which the speed, averaged in intervals, is rising (time)."""
    edges = np.linspace(0, speed.size, min(_SMOOTHED, speed.size) + 1).astype(int)
    means = np.add.reduceat(np.nan_to_num(speed), edges[:-1]) / np.diff(edges)
    return np.repeat(np.gradient(means) > 0, np.diff(edges))


def _binned(
    speed: np.ndarray, mu: np.ndarray, edges: np.ndarray
) -> tuple[list[float], list[float], list[float]]:
    rows = np.digitize(speed, edges)
    found = [
        (float(np.exp(np.log(speed[mine]).mean())), float(mu[mine].mean()), float(mu[mine].std()))
        for number in range(1, edges.size)
        if (mine := rows == number).sum() >= _MIN_SAMPLES
    ]
    x, mean, spread = zip(*found, strict=True) if found else ((), (), ())
    return list(x), list(mean), list(spread)
