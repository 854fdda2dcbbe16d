"""Consistency of the friction force with the recorded coefficient and the direction of motion."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.reading.interpret.names import split_unit
from tribolab.reading.runs.force_ratio import doubt_about, doubt_about_coefficient
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.quantities import unit_conversion

_RATIO = ("friction_coefficient", "friction_force", "normal_force")
_APART = 1.5  # ratio of two coefficients; filters and a zero by the instrument make less
_MIN_LOADED_ROWS = 20  # rows under load that are needed
_LOADED = 0.5  # of the largest load; above it, the contact is loaded
_OVER_N = re.compile(r"\w{1,3}\s*/\s*N")  # "Ff/N": in newtons, or divided by the normal force N


def disagreement(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[str]:
    """Return a guess if the recorded coefficient or forces are implausible or inconsistent.

    The list has one guess or none.
    """
    held = {column.quantity: column for column in columns if column.used and column.quantity}
    ratio, *forces = (held.get(name) for name in _RATIO)
    friction, load = (None if column is None else _si(column, numbers) for column in forces)
    if ratio is None:
        doubt = "" if friction is None or load is None else doubt_about(friction, load)
        return [f"{doubt} they are read as named"] if doubt else []
    stated = _si(ratio, numbers)
    if friction is None:
        doubt = doubt_about_coefficient(stated)
        return [f"{doubt} it is read as it stands"] if doubt else []
    if load is None:
        return []
    sound = np.isfinite(stated) & np.isfinite(friction) & np.isfinite(load) & (stated != 0)
    if sound.sum() < _MIN_LOADED_ROWS:
        return []
    sound &= np.abs(load) > _LOADED * np.abs(load[sound]).max()
    if sound.sum() < _MIN_LOADED_ROWS:
        return []
    ratios = stated[sound], friction[sound] / load[sound]
    sizes = [float(np.median(np.abs(x))) for x in ratios]
    if min(sizes) > 0 and max(sizes) / min(sizes) <= _APART:
        return []
    return [
        f"the forces are right, whose ratio is {sizes[1]:.3g}; column {ratio.place} states "
        f"{sizes[0]:.3g}"
    ]


def force_or_ratio(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Mark 'Ff/N' as a guess, unless another name also has its unit after a slash, as 't/s'."""
    if any(_has_unit_after_slash(column.label) for column in columns):
        return list(columns)
    return [
        column._replace(
            guessed=(*column.guessed, "'/N' says its unit, and not that a load was divided by"),
            options=(*column.options, "friction_coefficient"),
        )
        if column.used
        and column.quantity == "friction_force"
        and _OVER_N.fullmatch(column.label.strip())
        else column
        for column in columns
    ]


def _has_unit_after_slash(label: str) -> bool:
    name, unit = split_unit(label.strip())
    behind = label.strip()[len(name) :].lstrip().startswith("/")
    return unit is not None and behind and not _OVER_N.fullmatch(label.strip())


def _si(column: DraftColumn, numbers: np.ndarray) -> np.ndarray:
    scale, offset = unit_conversion(column.read_unit or "", str(column.quantity))
    return np.asarray(column.sign * scale * numbers[:, column.place - 1] + offset)


_MOVES, _RESTS = 0.05, 0.005  # of the highest speed: above, it slides; below, it rests
_FREE = 0.1  # of the highest load; below it, the contact is open
_MIN_ROWS = 20  # rows
_NEARLY_ALL = 0.95  # of the rows with sliding
_ALIKE = 0.05  # relative difference of two equal coefficients of friction
_CLEAR = 3.0  # least ratio of a signal to its scatter
_SPEEDS = ("sliding_velocity", "rotation_speed")
_PARTS = 2000  # intervals for a speed from a position: from row to row it would be noise
_JUMP = 0.25  # of the range of a position; a larger step between two intervals is a reset
COUNTED_SO = "it is counted against the motion: no friction drives what slides"


def against_motion(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[DraftColumn]:
    """Reverse the sign of a friction force that is negative whenever the sliding speed is positive.

    This must be true both with and without the reading at rest (or without load) subtracted,
    because a sensor offset may have any sign. Without rests nothing is changed: slow sliding is
    no rest, and its friction may exceed that of fast sliding.
    """
    force = [c for c in columns if c.used and c.quantity == "friction_force" and not c.optional]
    if len(force) != 1 or force[0].sign != 1:
        return list(columns)
    load = next((c for c in columns if c.used and c.quantity == "normal_force"), None)
    if load is not None and _is_negative_by_coefficient(columns, numbers, force[0], load):
        return _turned(columns, force[0])
    pressed = np.abs(numbers[:, load.place - 1]) if load is not None else np.ones(len(numbers))
    read = np.column_stack([numbers[:, force[0].place - 1], pressed])
    velocity, (signal, pressed) = _moving(columns, numbers, read.T)
    known = np.isfinite(velocity) & np.isfinite(signal) & np.isfinite(pressed)
    size = np.abs(velocity)
    free = known & (pressed < _FREE * np.max(pressed[known], initial=0.0))
    top = float(np.max(size[known & ~free], initial=0.0))
    moves = known & ~free & (size > _MOVES * top)
    by_load = np.count_nonzero(free) >= _MIN_ROWS
    rests = free if by_load else known & (size < _RESTS * top)
    if min(np.count_nonzero(rests), np.count_nonzero(moves)) < _MIN_ROWS:
        return list(columns)
    if not by_load and abs(np.median(velocity[rests])) > _CLEAR * _scatter(velocity[rests]):
        return list(columns)  # it slides slowly instead of resting
    way, zero = np.sign(velocity[moves]), float(np.median(signal[rests]))
    shown, along = way * signal[moves], way * (signal[moves] - zero)
    against = min((shown < 0).mean(), (along < 0).mean()) > _NEARLY_ALL
    if not against or not -np.median(along) > max(_CLEAR * _scatter(signal[rests]), abs(zero)):
        return list(columns)
    return _turned(columns, force[0])


def _turned(columns: Sequence[DraftColumn], force: DraftColumn) -> list[DraftColumn]:
    turned = force._replace(sign=-1, note=force.note or COUNTED_SO)
    return [turned if column is force else column for column in columns]


def _is_negative_by_coefficient(
    columns: Sequence[DraftColumn], numbers: np.ndarray, force: DraftColumn, load: DraftColumn
) -> bool:
    """Whether the friction is negative along the motion, but the recorded coefficient positive.

    The recorded coefficient shows the true sign, whatever the offset of the sensor.
    File: Rtec MFT, "DAQ.COF ()" 0.12, "DAQ.Fx (N)" -2.4, "DAQ.Fz (N)" -20; its program plots -Fx.
    """
    own = [c for c in columns if c.used and c.quantity == "friction_coefficient"]
    if len(own) != 1 or force.read_unit != load.read_unit or own[0].read_unit not in (None, "1"):
        return False
    velocity, (friction, pressed, ratio) = _moving(
        columns, numbers, numbers[:, [c.place - 1 for c in (force, load, own[0])]].T
    )
    moves = np.isfinite(velocity) & (velocity != 0) & np.isfinite(friction) & (ratio > 0)
    moves &= np.abs(pressed) > _FREE * np.nanmax(np.abs(pressed), initial=0.0)
    if np.count_nonzero(moves) < max(_MIN_ROWS, _NEARLY_ALL * len(velocity)):
        return False
    found = np.abs(friction[moves] / pressed[moves]) / ratio[moves]
    along = np.sign(velocity[moves]) * friction[moves]
    return bool((along < 0).mean() > _NEARLY_ALL and abs(np.median(found) - 1) < _ALIKE)


def _moving(
    columns: Sequence[DraftColumn], numbers: np.ndarray, signals: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the signed speed (any unit) and the signals at its rows; empty without a speed."""
    held = {c.quantity: c for c in columns if c.used}
    speed = next((held[name] for name in _SPEEDS if name in held), None)
    if speed is not None:
        return speed.sign * numbers[:, speed.place - 1], signals
    position = held.get("position")
    if position is None or not len(numbers):
        return np.empty(0), signals[:, :0]
    step = max(len(numbers) // _PARTS, 1)
    places = numbers[::step, position.place - 1]
    ways = position.sign * np.diff(places)
    known = places[np.isfinite(places)]
    ways[np.abs(ways) > _JUMP * (np.ptp(known) if known.size else 0.0)] = np.nan
    return ways, signals[:, ::step][:, : ways.size]


def _scatter(values: np.ndarray) -> float:
    return 1.4826 * float(np.median(np.abs(values - np.median(values))))
