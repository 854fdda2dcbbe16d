"""Monitored values of a rig in a results folder: zeros, noise, tilt, set-points, clocks."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import csv as arrow_csv

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.naming.named import is_named
from tribolab.comparison.folder import REPORT, Folder, open_folder
from tribolab.comparison.run_values import speed_levels
from tribolab.core.errors import ReadError, brief
from tribolab.core.untyped import Json
from tribolab.core.wording import speed_text

REFERENCE = "friction of the reference"
_TILT, GAIN = "tilt found", "gain of the normal force"

_FRICTION = [
    "run",
    "sliding_speed_m_s",
    "set_speed_m_s",
    "friction_coefficient",
    "normal_force_N",
    "nominal_normal_force_N",
    "friction_force_offset_N",
    "normal_force_offset_N",
    "tilt_found_rad",
]
SeriesColumns = dict[str, np.ndarray]
_ALONE = arrow_csv.ReadOptions(use_threads=False)  # for small tables, threads slow reading down
_SLIP = ["run", "sample_noise", "mains_amplitude"]


@dataclass(frozen=True)
class Observation:
    """One value of one monitored quantity, of one instrument in one campaign.

    Parameters
    ----------
    instrument, quantity, unit
        Identification.
    when
        Start of the campaign.
    folder
        The results folder.
    value
        Value in that unit.
    speed
        Sliding speed [m/s]; NaN if not applicable.
    """

    instrument: str
    quantity: str
    unit: str
    when: dt.datetime
    folder: str
    value: float
    speed: float = math.nan


def results_below(folders: Iterable[str | Path]) -> list[Path]:
    """Return all results folders that are, or are inside, the given folders."""
    places: list[Path] = []
    for folder in map(Path, folders):
        own = (
            [folder] if any((at / REPORT).is_file() for at in (folder, folder / "results")) else []
        )
        below = sorted(file.parent for file in folder.rglob(REPORT)) if not own else []
        places += own or below or [folder]
    return list(dict.fromkeys(places))


def observations_of(path: str | Path) -> tuple[list[Observation], Folder]:
    """Return the observations of the instruments in a results folder, and the opened folder.

    Raises
    ------
    ReadError
        If it is not a results folder.
    """
    folder = open_folder(path)
    friction = _segments(folder)
    if not folder.done:
        return [], folder
    slip = _table(folder, "stick_slip", _SLIP)
    made: list[Observation] = []
    for name in dict.fromkeys(str(run.get("instrument", "")) for run in folder.done):
        runs = [run for run in folder.done if str(run.get("instrument", "")) == name]
        names = {run["name"] for run in runs}
        mine = _select_runs(friction, names)
        noise = None if slip is None else _select_runs(slip, names)
        when = _start_time(runs, folder.made_at)
        for quantity, unit, value in _numbers(folder.campaign, runs, mine, noise):
            if np.isfinite(value):
                made.append(Observation(name, quantity, unit, when, str(folder.path), value))
        for value, speed in _reference_friction(folder.campaign, runs, mine):
            made.append(Observation(name, REFERENCE, "1", when, str(folder.path), value, speed))
    return made, folder


def _segments(folder: Folder) -> SeriesColumns:
    """Return the monitored columns of the segments of all runs."""
    rows = folder.segments
    known = {name: [row.get(name) for row in rows] for name in _FRICTION}
    return {
        name: np.array(values, dtype=object if name == "run" else float)
        for name, values in known.items()
    }


def _table(folder: Folder, name: str, columns: Sequence[str]) -> SeriesColumns | None:
    """Return some columns of a table, ten times faster than by reading the whole table."""
    path = folder.path / "tables" / f"{name}.csv"
    if not path.is_file():
        return None
    try:
        options = arrow_csv.ConvertOptions(
            include_columns=list(columns),
            include_missing_columns=True,
            column_types={c: pa.string() if c == "run" else pa.float64() for c in columns},
        )
        table = arrow_csv.read_csv(path, _ALONE, convert_options=options)
    except (OSError, pa.ArrowInvalid) as error:
        raise ReadError(f"{path}: no table ({brief(error)})") from error
    pairs = zip(table.column_names, table.columns, strict=True)
    return {name: column.to_numpy() for name, column in pairs}


def _select_runs(table: SeriesColumns, names: Collection[str]) -> SeriesColumns:
    """Return the rows of a table that belong to some runs."""
    mine = np.array([run in names for run in table["run"]], dtype=bool)
    return {name: column[mine] for name, column in table.items()}


def _start_time(runs: Iterable[Json], otherwise: dt.datetime) -> dt.datetime:
    """Return the start of the first run, without time zone; else the time of the analysis."""
    known = []
    for run in runs:
        try:
            known.append(dt.datetime.fromisoformat(run["recorded_at"]).replace(tzinfo=None))
        except (KeyError, ValueError):
            continue
    return min(known, default=otherwise.replace(tzinfo=None))


def _numbers(
    campaign: Campaign | None,
    runs: Sequence[Json],
    friction: SeriesColumns,
    slip: SeriesColumns | None,
) -> Iterable[tuple[str, str, float]]:
    """Yield the quantity, unit and value of each monitored number."""
    column = friction
    yield "zero of the friction force", "N", _finite_mean(column["friction_force_offset_N"])
    yield "zero of the normal force", "N", _finite_mean(column["normal_force_offset_N"])
    tilt = _finite_mean(column["tilt_found_rad"])
    if not np.isfinite(tilt):
        tilt = _tilt(column["friction_force_offset_N"], column["normal_force_N"])
    yield _TILT, "rad", tilt
    for what, value, wanted in (
        ("speed", "sliding_speed_m_s", "set_speed_m_s"),
        ("load", "normal_force_N", "nominal_normal_force_N"),
    ):
        ratio = column[value] / np.where(column[wanted] > 0, column[wanted], np.nan)
        yield f"set-point error of the {what}", "1", _finite_mean(ratio) - 1
    if slip is not None:
        yield "noise of friction", "1", _finite_mean(slip["sample_noise"])
        yield "hum of the mains", "1", _finite_mean(slip["mains_amplitude"])
    shifts = [run.get("clock_shift_s") for run in runs]
    yield (
        "clock shift",
        "s",
        _finite_mean(np.array([s for s in shifts if s is not None], dtype=float)),
    )
    if campaign is not None:
        yield GAIN, "1", _gain(campaign, runs, friction)


def _gain(campaign: Campaign, runs: Sequence[Json], friction: SeriesColumns) -> float:
    """Return the gain from a dead weight, found on reference runs or else from their load."""
    mine = _reference_runs(campaign, runs)
    gains = [run.get("dead_weight_gain") for run in runs if run["name"] in mine]
    if gains_known := [float(gain) for gain in gains if gain is not None]:
        return float(np.mean(gains_known))
    weight = campaign.reference.dead_weight
    if weight is None:
        return float("nan")
    return _finite_mean(_select_runs(friction, mine)["normal_force_N"]) / weight


def _reference_runs(campaign: Campaign, runs: Sequence[Json]) -> set[str]:
    """Return the names of the runs on the reference sample."""
    files = campaign.reference.files
    if files is None:
        return set()
    return {
        run["name"] for run in runs if any(is_named(campaign, files, file) for file in run["files"])
    }


def _reference_friction(
    campaign: Campaign | None, runs: Sequence[Json], friction: SeriesColumns
) -> Iterable[tuple[float, float]]:
    """Yield the mean friction on the reference sample and the speed, for each speed."""
    if campaign is None:
        return
    mine = _select_runs(friction, _reference_runs(campaign, runs))
    value, speed = mine["friction_coefficient"], mine["sliding_speed_m_s"]
    known = np.isfinite(value) & (speed > 0)
    if not known.any():
        return
    levels = speed_levels(speed[known])
    for level in np.unique(levels).tolist():
        yield _finite_mean(value[known][levels == level]), level


def group_by_speed(points: Sequence[Observation]) -> list[Observation]:
    """Return the observations grouped by common speeds of all campaigns.

    Small differences of a campaign's mean speed must not create a new quantity.

    Examples
    --------
    >>> day = dt.datetime(2026, 1, 1)
    >>> points = [Observation("a", "friction", "1", day, "x", 0.5, v) for v in (2.14e-3, 2.16e-3)]
    >>> [point.quantity for point in group_by_speed(points)]
    ['friction at 2.15 mm/s', 'friction at 2.15 mm/s']
    """
    made = [point for point in points if math.isnan(point.speed)]
    moving: dict[tuple[str, str], list[Observation]] = {}
    for point in points:
        if not math.isnan(point.speed):
            moving.setdefault((point.instrument, point.quantity), []).append(point)
    for own in moving.values():
        levels = speed_levels(np.array([point.speed for point in own])).tolist()
        made += [
            replace(point, quantity=f"{point.quantity} at {speed_text(level)}")
            for point, level in zip(own, levels, strict=True)
        ]
    return made


def _finite_mean(values: np.ndarray) -> float:
    """Return the mean of the finite values; NaN if there are none."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")


def _tilt(offset: np.ndarray, load: np.ndarray) -> float:
    """Return the tilt angle of the force cell, from offset against load; NaN for a single load."""
    known = np.isfinite(offset) & np.isfinite(load)
    if known.sum() < 3 or np.ptp(load[known]) < 0.2 * np.abs(load[known]).max():
        return float("nan")
    return float(np.arctan(np.polyfit(load[known], offset[known], 1)[0]))
