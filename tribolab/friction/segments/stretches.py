"""Intervals of sliding and rest of a run, from its velocity, position, steps or set speed."""

from __future__ import annotations

from itertools import groupby
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import anywhere
from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import AnalysisError
from tribolab.friction.segments import limits, slopes
from tribolab.friction.segments.constancy import MeanVelocities
from tribolab.friction.segments.locate import locate
from tribolab.friction.segments.pieces import ConstancyLimits, VelocityPiece, moving, trimmed
from tribolab.friction.segments.turns import strokes_within
from tribolab.friction.time_weights import without_gaps

_INTERVALS_OF_GAP = 4  # a pause is compared with this many sampling intervals on each side


class Stretch(NamedTuple):
    """Interval of a run [s], its kind ("constant": a segment) and its mean velocity [m/s]."""

    start: float
    stop: float
    kind: str
    velocity: float


def name_of(run: xr.Dataset) -> str:
    """Return the name of the run for error messages: its source file if known."""
    return str(run.attrs.get("source", "run"))


def velocity_source(run: xr.Dataset) -> str:
    """Return the best source of a run's speed: recorded, position, step or set speed."""
    stated = "set_speed" in run or "set_speed_m_s" in run.attrs
    clocked = RunAttributes.from_attrs(run.attrs).time_source != "row number"
    for name, source in (("sliding_velocity", "recorded"), ("position", "position")):
        if name == "position" and stated and not clocked:
            continue  # without a clock, a position gives no speed
        if name in run and anywhere(np.isfinite, run[name].values):
            return source
    if "step" in run:
        return "step"
    if "sliding_velocity" in run or ("position" in run and (clocked or not stated)):
        # all values are NaN: the run gets no segments, but a reason
        return "recorded" if "sliding_velocity" in run else "position"
    if stated:
        return "set speed"
    if "rotation_speed" in run:
        raise AnalysisError(
            f"{name_of(run)}: the rotation is recorded, but the sliding speed needs the radius of "
            'the track: state --radius 15mm, or radius = "15 mm" under [speed] of the '
            "instrument's file; if a crank drives strokes, state stroke, frequency and "
            "source = 'stroke' there"
        )
    if not {"friction_force", "friction_coefficient", "shear_stress"} & set(run.data_vars):
        found = ", ".join(map(str, run.data_vars)) or "nothing"
        raise AnalysisError(f"{name_of(run)}: neither friction nor speed is recorded, but {found}")
    raise AnalysisError(
        f"{name_of(run)}: nothing tells the sliding speed; the run needs one of 'sliding_velocity',"
        " 'position', 'step', 'set_speed', or the attribute 'set_speed_m_s'; a campaign "
        'file may say it: sliding_speed = "1 mm/s" in its [[run]]'
    )


def finite(run: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the times and values of a signal at the samples where it is finite."""
    time, values = run["time"].values, np.asarray(run[name].values, dtype=float)
    if np.isfinite(values.sum()):  # the sum is finite if all values are
        return time, values
    good = np.isfinite(values)
    return time[good], values[good]


def track(run: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return times and positions of the finite samples, without jumps by sensor resets."""
    time, position = finite(run, "position")
    return time, slopes.without_resets(time, position)[0]


def of_points(run: xr.Dataset) -> list[Stretch]:
    """Return an interval of zero length for each row of a file whose rows are results."""
    time = run["time"].values
    name = next((n for n in ("sliding_velocity", "set_speed") if n in run), "")
    if not name:
        raise AnalysisError(f"{name_of(run)}: its rows are points, but nothing tells their speed")
    speed = np.asarray(run[name].values, dtype=float)
    known = np.isfinite(speed)
    kinds = np.where(known & (speed != 0), "constant", np.where(known, "at rest", "not a number"))
    return [
        Stretch(float(at), float(at), str(kind), float(v))
        for at, kind, v in zip(time, kinds, speed, strict=True)
    ]


def from_velocity(
    run: xr.Dataset, constancy: ConstancyLimits, max_gap: float | None
) -> list[Stretch]:
    """Return the intervals of a run from the recorded velocity."""
    time, velocity = finite(run, "sliding_velocity")
    if time.size < 2:
        return _nothing(run, time.size)
    pieces, share = locate(time, velocity, constancy), 0.05
    pieces = moving(time, pieces, constancy, velocity)
    pieces = trimmed(MeanVelocities(time, velocity=velocity), pieces, constancy)
    return _split_at_gaps(run, time, pieces, constancy, max_gap, share)


def from_position(
    run: xr.Dataset, constancy: ConstancyLimits, max_gap: float | None
) -> list[Stretch]:
    """Return the intervals of a run from the position, by slopes over blocks."""
    time, position = track(run)
    if time.size < 3 * limits.MIN_SAMPLES_OF_BLOCK.value:
        return _nothing(run, time.size)
    pieces = _by_slopes(time, position, constancy, limits.MIN_SAMPLES_OF_BLOCK.value)
    pieces = trimmed(MeanVelocities(time, position=position), pieces, constancy)
    pieces = strokes_within(time, position, pieces, constancy)
    pieces = moving(time, [_with_slope(time, position, p) for p in pieces], constancy)
    if constancy.rest_speed is None:
        pieces = _mark_dwells(time, pieces, slopes.position_noise(time, position))
    share = 0.25  # longer pauses are allowed: the position shows the mean speed across them
    return _split_at_gaps(run, time, pieces, constancy, max_gap, share)


def _by_slopes(
    time: np.ndarray, position: np.ndarray, constancy: ConstancyLimits, least: int
) -> list[VelocityPiece]:
    """Return velocity pieces from slopes of the position over blocks, longer for slow motion."""
    t, v, size, error = slopes.velocity_blocks(time, position, least)
    fewest = constancy._replace(min_samples=max(3, constancy.min_samples // size))
    # a block of rounded positions shows no noise, or a whole step: assume at least the usual error
    noise = slopes.position_noise(time, position)
    floor = error if slopes.is_rounding(position, noise) else 0.0
    blocks = locate(t, v, fewest, floor)
    pieces = [p._replace(first=p.first * size, last=p.last * size) for p in blocks]
    pieces[-1] = pieces[-1]._replace(last=time.size)
    pieces = _move_borders(time, position, pieces, size)
    if error == 0:
        return pieces
    result: list[VelocityPiece] = []
    slow = [abs(p.velocity) < limits.MIN_SPEED_OVER_ERROR.value * error for p in pieces]
    for is_slow, some in groupby(zip(slow, pieces, strict=True), key=lambda pair: pair[0]):
        group = [piece for _, piece in some]
        first, last = group[0].first, group[-1].last
        if is_slow and last - first >= 128 * size:
            inner = _by_slopes(time[first:last], position[first:last], constancy, 2 * size)
            group = [p._replace(first=p.first + first, last=p.last + first) for p in inner]
        result += group
    return result


def _with_slope(time: np.ndarray, position: np.ndarray, piece: VelocityPiece) -> VelocityPiece:
    if piece.kind != "constant":
        return piece
    inside = slice(piece.first, piece.last)
    return piece._replace(velocity=slopes.line(time[inside], position[inside])[1])


def _mark_dwells(
    time: np.ndarray, pieces: list[VelocityPiece], noise: float
) -> list[VelocityPiece]:
    """Reclassify as rest those plateaus (dwells at turns) that do not exceed the position noise."""
    return [
        piece._replace(kind="at rest")
        if piece.kind == "constant"
        and abs(piece.velocity) * (time[piece.last - 1] - time[piece.first])
        < limits.MIN_DISTANCE_OVER_NOISE.value * noise
        else piece
        for piece in pieces
    ]


def _move_borders(
    time: np.ndarray, position: np.ndarray, pieces: list[VelocityPiece], size: int
) -> list[VelocityPiece]:
    """Move the border of two neighbouring plateaus to the intersection of their lines."""
    kept = [i for i, p in enumerate(pieces) if p.kind == "constant"]
    result = list(pieces)
    for i, j in zip(kept[:-1], kept[1:], strict=True):
        left, right = result[i], result[j]
        if right.first - left.last > 3 * size:
            continue
        near = 20 * size  # the speed drifts within a plateau: only its end determines the border
        (a, va), (b, vb) = (
            slopes.line(time[first:last], position[first:last])
            for first, last in (
                (max(left.first, left.last - near), left.last),
                (right.first, min(right.last, right.first + near)),
            )
        )
        crossing = (a - b) / (vb - va) if va != vb else np.nan
        index = int(np.searchsorted(time, crossing)) if np.isfinite(crossing) else -1
        if left.last - 2 * size <= index <= right.first + 2 * size:
            result[i] = left._replace(last=index)
            result[j] = right._replace(first=index)
            for k in range(i + 1, j):
                result[k] = result[k]._replace(first=index, last=index)
    return [p for p in result if p.last > p.first]


def _nothing(run: xr.Dataset, finite: int) -> list[Stretch]:
    time = run["time"].values
    reason = "too short" if finite else "not a number"
    return [Stretch(float(time[0]), float(time[-1]), reason, np.nan)]


def _split_at_gaps(
    run: xr.Dataset,
    time: np.ndarray,
    pieces: list[VelocityPiece],
    constancy: ConstancyLimits,
    max_gap: float | None,
    share: float,
) -> list[Stretch]:
    """Return the pieces as intervals of time, split where samples are missing or not numbers."""
    result: list[Stretch] = []
    whole = run["time"].values
    if time[0] > whole[0]:
        result.append(Stretch(float(whole[0]), float(time[0]), "not a number", np.nan))
    for piece in pieces:
        at = _gaps(time, piece, max_gap, share)
        edges = [piece.first, *(at + 1), piece.last]
        for first, last in zip(edges[:-1], edges[1:], strict=True):
            kind = piece.kind
            if kind == "constant" and last - first < constancy.min_samples:
                kind = "too short"
            stop = time[last - 1]
            if last == piece.last and last < time.size and not _is_gap(time, last - 1, piece):
                stop = time[last]
            result.append(Stretch(float(time[first]), float(stop), kind, piece.velocity))
            if last < piece.last:
                result.append(Stretch(float(stop), float(time[last]), "gap", np.nan))
    if time[-1] < whole[-1]:
        result.append(Stretch(float(time[-1]), float(whole[-1]), "not a number", np.nan))
    return result


def _is_gap(time: np.ndarray, index: int, piece: VelocityPiece) -> bool:
    """Return whether the time to the next sample is much longer than usual in a piece."""
    usual = (time[piece.last - 1] - time[piece.first]) / max(piece.last - piece.first - 1, 1)
    return bool(time[index + 1] - time[index] > 3 * usual)


def _gaps(
    time: np.ndarray, piece: VelocityPiece, max_gap: float | None, share: float
) -> np.ndarray:
    """Return the indices of samples of a plateau or ramp before a long pause."""
    inside = time[piece.first : piece.last]
    if piece.kind not in ("constant", "ramp") or inside.size < 2:
        return np.zeros(0, dtype=int)
    step = max(1, inside.size // 4096)
    marks = np.append(inside[::step], inside[-1])
    spans = np.diff(marks)
    longest = max_gap
    if longest is None:
        usual = float(median(spans)) / step
        longest = max(20 * usual, share * float(inside[-1] - inside[0]))
    wide = np.flatnonzero(spans > longest)  # only these can contain such a pause
    parts = []
    for block in wide:
        near = max(int(block) * step - _INTERVALS_OF_GAP, 0)
        steps = np.diff(inside[near : (block + 1) * step + _INTERVALS_OF_GAP + 1])
        # a slower rate is not a gap: it has equally long intervals next to it
        alone = (steps > without_gaps(steps)) | (max_gap is not None)
        gap = near + np.flatnonzero((steps > longest) & alone)
        parts.append(gap[(gap >= block * step) & (gap < (block + 1) * step)])
    return piece.first + np.concatenate(parts) if parts else np.zeros(0, dtype=int)


def from_steps(run: xr.Dataset, min_samples: int) -> list[Stretch]:
    """Return an interval for each step (or stroke) that the instrument numbered."""
    time, step = run["time"].values, run["step"].values
    known = ~np.isnan(step.astype(float))
    edges = np.flatnonzero((step[1:] != step[:-1]) & (known[1:] | known[:-1])) + 1
    edges = np.concatenate([[0], edges, [time.size]])
    result = []
    for first, last in zip(edges[:-1], edges[1:], strict=True):
        kind = "constant" if last - first >= min_samples else "too short"
        if not known[first]:
            kind = "not a number"
        speed = _set_speed(run, first, last)
        result.append(
            Stretch(
                float(time[first]), float(time[last - 1]), kind, _signed(run, first, last, speed)
            )
        )
    return result


def from_set_speed(run: xr.Dataset, min_samples: int) -> list[Stretch]:
    """Return one interval for each set speed, or the whole record for a single value."""
    time = run["time"].values
    if "set_speed" in run:
        value = np.asarray(run["set_speed"].values, dtype=float)
        edges = np.flatnonzero(np.diff(value) != 0) + 1
        edges = np.concatenate([[0], edges, [time.size]])
    else:
        edges = np.array([0, time.size])
    result = []
    for first, last in zip(edges[:-1], edges[1:], strict=True):
        speed = _set_speed(run, first, last)
        kind = "constant" if last - first >= min_samples else "too short"
        if speed == 0:
            kind = "at rest"
        result.append(
            Stretch(
                float(time[first]), float(time[last - 1]), kind, _signed(run, first, last, speed)
            )
        )
    return result


def _set_speed(run: xr.Dataset, first: int, last: int) -> float:
    if "set_speed" in run:
        values = np.asarray(run["set_speed"].values[first:last], dtype=float)
        values = values[np.isfinite(values)]
        return float(median(values)) if values.size else np.nan
    return RunAttributes.from_attrs(run.attrs).set_speed_m_s


def _signed(run: xr.Dataset, first: int, last: int, speed: float) -> float:
    """Return the set speed with the sign of the mean friction; positive if friction is unknown."""
    for name in ("friction_force", "friction_coefficient"):
        if name in run:
            values = run[name].values[first:last]
            if np.isfinite(values).any():
                return float(np.copysign(speed, np.nanmean(values)))
    return speed
