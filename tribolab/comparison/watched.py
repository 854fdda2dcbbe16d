"""What a results folder says of its rig: zeros, noise, tilt, set points, clocks, a reference."""

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
_ALONE = arrow_csv.ReadOptions(use_threads=False)  # small tables: threads cost more than they save
_SLIP = ["run", "sample_noise", "mains_amplitude"]


@dataclass(frozen=True)
class Observation:
    """One number of one campaign on one instrument.

    Parameters
    ----------
    instrument, quantity, unit
        What it is of.
    when
        When the campaign began.
    folder
        The results folder.
    value
        In that unit.
    speed
        At which sliding speed [m/s]; NaN of what has none.
    """

    instrument: str
    quantity: str
    unit: str
    when: dt.datetime
    folder: str
    value: float
    speed: float = math.nan


def results_below(folders: Iterable[str | Path]) -> list[Path]:
    """Return results folders: those that are named, and of other folders those below them."""
    places: list[Path] = []
    for folder in map(Path, folders):
        own = (
            [folder] if any((at / REPORT).is_file() for at in (folder, folder / "results")) else []
        )
        below = sorted(file.parent for file in folder.rglob(REPORT)) if not own else []
        places += own or below or [folder]
    return list(dict.fromkeys(places))


def observations_of(path: str | Path) -> tuple[list[Observation], Folder]:
    """Return what a results folder says of its instruments, and the folder.

    Raises
    ------
    ReadError
        If it is none.
    """
    folder = open_folder(path)
    friction = _table(folder, "friction", _FRICTION)
    if friction is None:
        return [], folder
    slip = _table(folder, "stick_slip", _SLIP)
    made: list[Observation] = []
    for name in dict.fromkeys(str(run.get("instrument", "")) for run in folder.done):
        runs = [run for run in folder.done if str(run.get("instrument", "")) == name]
        names = {run["name"] for run in runs}
        mine = _of_runs(friction, names)
        noise = None if slip is None else _of_runs(slip, names)
        when = _began(runs, folder.made_at)
        for quantity, unit, value in _numbers(folder.campaign, runs, mine, noise):
            if np.isfinite(value):
                made.append(Observation(name, quantity, unit, when, str(folder.path), value))
        for value, speed in _of_reference(folder.campaign, runs, mine):
            made.append(Observation(name, REFERENCE, "1", when, str(folder.path), value, speed))
    return made, folder


def _table(folder: Folder, name: str, columns: Sequence[str]) -> SeriesColumns | None:
    """Read some columns of a table, which is a tenth of the work for all of them."""
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


def _of_runs(table: SeriesColumns, names: Collection[str]) -> SeriesColumns:
    """Return the rows of some runs."""
    mine = np.array([run in names for run in table["run"]], dtype=bool)
    return {name: column[mine] for name, column in table.items()}


def _began(runs: Iterable[Json], otherwise: dt.datetime) -> dt.datetime:
    """Return when the first run was recorded, without a time zone; else when results were made."""
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
    """Yield quantity, unit and value."""
    column = friction
    yield "zero of the friction force", "N", _middle(column["friction_force_offset_N"])
    yield "zero of the normal force", "N", _middle(column["normal_force_offset_N"])
    tilt = _middle(column["tilt_found_rad"])
    if not np.isfinite(tilt):
        tilt = _tilt(column["friction_force_offset_N"], column["normal_force_N"])
    yield _TILT, "rad", tilt
    for what, value, wanted in (
        ("speed", "sliding_speed_m_s", "set_speed_m_s"),
        ("load", "normal_force_N", "nominal_normal_force_N"),
    ):
        ratio = column[value] / np.where(column[wanted] > 0, column[wanted], np.nan)
        yield f"set-point error of the {what}", "1", _middle(ratio) - 1
    if slip is not None:
        yield "noise of friction", "1", _middle(slip["sample_noise"])
        yield "hum of the mains", "1", _middle(slip["mains_amplitude"])
    shifts = [run.get("clock_shift_s") for run in runs]
    yield "clock shift", "s", _middle(np.array([s for s in shifts if s is not None], dtype=float))
    if campaign is not None:
        yield GAIN, "1", _gain(campaign, runs, friction)


def _gain(campaign: Campaign, runs: Sequence[Json], friction: SeriesColumns) -> float:
    """Return the gain by a dead weight: as runs on the reference tell, else by their load."""
    mine = _reference_runs(campaign, runs)
    gains = [run.get("dead_weight_gain") for run in runs if run["name"] in mine]
    if told := [float(gain) for gain in gains if gain is not None]:
        return float(np.mean(told))
    weight = campaign.reference.dead_weight
    if weight is None:
        return float("nan")
    return _middle(_of_runs(friction, mine)["normal_force_N"]) / weight


def _reference_runs(campaign: Campaign, runs: Sequence[Json]) -> set[str]:
    """Return the names of the runs on a reference sample."""
    files = campaign.reference.files
    if files is None:
        return set()
    return {
        run["name"] for run in runs if any(is_named(campaign, files, file) for file in run["files"])
    }


def _of_reference(
    campaign: Campaign | None, runs: Sequence[Json], friction: SeriesColumns
) -> Iterable[tuple[float, float]]:
    """Yield mean friction on a reference sample and the speed, for each speed."""
    if campaign is None:
        return
    mine = _of_runs(friction, _reference_runs(campaign, runs))
    value, speed = mine["friction_coefficient"], mine["sliding_speed_m_s"]
    known = np.isfinite(value) & (speed > 0)
    if not known.any():
        return
    levels = speed_levels(speed[known])
    for level in np.unique(levels).tolist():
        yield _middle(value[known][levels == level]), level


def at_common_speeds(points: Sequence[Observation]) -> list[Observation]:
    """Name what has a speed by the one that it has in common with other campaigns.

    A campaign's own mean must not make another quantity of it.

    Examples
    --------
    >>> day = dt.datetime(2026, 1, 1)
    >>> points = [Observation("a", "friction", "1", day, "x", 0.5, v) for v in (2.14e-3, 2.16e-3)]
    >>> [point.quantity for point in at_common_speeds(points)]
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


def _middle(values: np.ndarray) -> float:
    """Return the mean of what is known; NaN of nothing."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")


def _tilt(offset: np.ndarray, load: np.ndarray) -> float:
    """Angle between the axes of force cell and load: what the common offset grows by with load.

    NaN where one load alone was measured: a zero and a tilt cannot be told apart then.
    """
    known = np.isfinite(offset) & np.isfinite(load)
    if known.sum() < 3 or np.ptp(load[known]) < 0.2 * np.abs(load[known]).max():
        return float("nan")
    return float(np.arctan(np.polyfit(load[known], offset[known], 1)[0]))
