"""Sliding speed of a run without a speed column: from rotation, strokes, or the set-point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.errors import LacksError, ReadError
from tribolab.core.untyped import Json
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.runs.stroke_speed import FEWEST_CYCLES, velocity_of_strokes
from tribolab.units.conversion import to_si


def add_speed(
    columns: dict[str, np.ndarray],
    attrs: Json,
    time: np.ndarray,
    where: str,
    dialect: Dialect,
    of_steps: Mapping[str, np.ndarray] | None = None,
) -> None:
    """Add the sliding speed from the source stated in the dialect.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time); the speed is added.
    attrs
        Attributes of the run, including values outside the table; changed in place.
    time
        Time [s] (time).
    where
        The run, for messages.
    dialect
        The instrument's dialect.
    of_steps
        From `keep_settings`.

    Raises
    ------
    ReadError
        If an input of the speed is missing.
    """
    source = dialect.speed.source
    if source == "rotation":
        _by_turns(columns, attrs, where, dialect, of_steps or {})
    elif source == "stroke" and of_steps:
        _by_strokes_of_steps(columns, attrs, time, where, dialect, of_steps)
    elif source == "stroke":
        _by_strokes(columns, attrs, time, where, dialect)
    elif source == "set speed" and "set_speed" not in columns and "set_speed_m_s" in attrs:
        columns["set_speed"] = np.full(len(time), float(attrs["set_speed_m_s"]))


def keep_settings(
    columns: Mapping[str, np.ndarray],
    symbols: Mapping[str, str],
    attrs: Json,
    where: str,
    dialect: Dialect,
) -> dict[str, np.ndarray]:
    """Store radius, stroke or frequency given in columns, before these columns are removed.

    Parameters
    ----------
    columns
        Arrays in SI by quantity or symbol (time).
    symbols
        SI units of the symbols.
    attrs
        Attributes of the run; changed in place.
    where
        The run, for messages.
    dialect
        The instrument's dialect.

    Returns
    -------
    dict
        Settings that differ between steps, in SI (time), by key of ``[speed]``.

    Raises
    ------
    ReadError
        If such a column is neither constant nor stepwise, or a step lacks a setting that others
        state.
    """
    before_steps = {v.name: v.si_unit for v in dialect.value if v.source == "step" and v.unit}
    of_steps: dict[str, np.ndarray] = {}
    for key, name in dialect.speed.values_named.items():
        if name not in {*symbols, *before_steps} or name not in columns:
            continue
        values, symbol_unit = columns[name], symbols.get(name) or before_steps[name]
        if name in before_steps and np.any(values != values[0]):
            of_steps[key] = _of_each_step(values, name, symbol_unit, where)
            continue
        turns = key == "frequency_value" and symbol_unit.startswith("rad")
        present = values[np.isfinite(values) & (values > 0)]
        middle = float(median(present)) if present.size else np.nan
        if present.size and np.any(np.abs(present / middle - 1) > _VARIES):
            levels = level_of_each(values)
            if levels is None or key == "radius_value":
                raise ReadError(
                    f"column '{name}' holds {present.min():.4g} to {present.max():.4g}; a speed "
                    "that follows from it needs one number for a run, or for each step of it: "
                    "part the run where it changes",
                    where=where,
                )
            of_steps[key] = levels / (2 * np.pi) if turns else levels
            continue
        unit = "Hz" if key == "frequency_value" else "m"
        attrs[f"{name}_{unit}"] = middle / (2 * np.pi) if turns else middle
    return of_steps


def _of_each_step(values: np.ndarray, name: str, unit: str, where: str) -> np.ndarray:
    if not np.all(values > 0):
        known = values[values > 0]
        text = f"{known.min():.4g} to {known.max():.4g}" if known.size else "nothing above zero"
        raise ReadError(
            f"'{name}' stands before some steps ({text}) and is missing or zero before others; "
            "state it before each",
            where=where,
        )
    return values / (2 * np.pi) if unit.startswith("rad") else values


def _by_turns(
    columns: dict[str, np.ndarray],
    attrs: Json,
    where: str,
    dialect: Dialect,
    of_steps: Mapping[str, np.ndarray],
) -> None:
    radius: float | np.ndarray | None = of_steps.get("radius_value")
    if radius is None:
        radius = _stated(dialect.speed.radius, dialect.speed.radius_value, "m", attrs)
    if radius is None or "rotation_speed" not in columns:
        raise LacksError(
            f"{where}: the speed should follow from rotation_speed and a radius, but "
            f"{'the radius' if radius is None else 'the column rotation_speed'} is missing "
            f"(instrument '{dialect.name}', [speed])"
        )
    columns["sliding_velocity"] = columns["rotation_speed"] * radius


def _by_strokes(
    columns: dict[str, np.ndarray], attrs: Json, time: np.ndarray, where: str, dialect: Dialect
) -> None:
    speed = dialect.speed
    stroke = _stated(speed.stroke, speed.stroke_value, "m", attrs)
    frequency = _stated(speed.frequency, speed.frequency_value, "Hz", attrs)
    signals = [columns[name] for name in _SIGNALS if name in columns]
    if stroke is None or frequency is None or not signals:
        lost = {"the stroke": stroke, "the frequency": frequency, "a friction signal": signals}
        raise LacksError(
            "the speed should follow from stroke and frequency, but "
            f"{' and '.join(name for name, there in lost.items() if not there)} is missing "
            f"(instrument '{dialect.name}', [speed])",
            where=where,
        )
    attrs |= {"stroke_m": stroke, "stroke_frequency_Hz": frequency}
    strokes = velocity_of_strokes(time, signals[0], stroke, frequency, speed.drive)
    if strokes is None:  # the mean speed of both directions is known nevertheless
        attrs["set_speed_m_s"] = 2 * stroke * frequency
        attrs["strokes_not_seen_Hz"] = frequency
        return
    attrs["stroke_frequency_Hz"] = strokes.frequency
    if strokes.unlike:
        attrs["strokes_unlike_s"] = strokes.unlike
    columns["sliding_velocity"] = strokes.velocity


def _by_strokes_of_steps(
    columns: dict[str, np.ndarray],
    attrs: Json,
    time: np.ndarray,
    where: str,
    dialect: Dialect,
    of_steps: Mapping[str, np.ndarray],
) -> None:
    """Compute the sliding velocity if stroke or frequency differ between steps.

    A step with a frequency of zero is a rest. If friction reverses in no step, it was recorded
    without its sign or as means over cycles; then the mean speed of the strokes is stored as
    ``set_speed``.
    """
    changes = [np.flatnonzero(np.diff(values)) + 1 for values in of_steps.values()]
    bounds = np.unique(np.concatenate([[0], *changes, [len(time)]]))
    if not _changes_with_steps(columns.get("step"), bounds):
        columns["step"] = np.repeat(np.arange(1, len(bounds)), np.diff(bounds)).astype(np.int32)
    velocity, mean_speed = np.zeros(len(time)), np.zeros(len(time))
    steps: list[Json] = []
    without: list[tuple[int, int, float]] = []  # first and last row, frequency
    for first, stop in zip(bounds[:-1], bounds[1:], strict=True):
        if any(values[first] == 0 for values in of_steps.values()):
            continue
        part = {name: columns[name][first:stop] for name in _SIGNALS if name in columns}
        own = dict(attrs)
        for key, values in of_steps.items():
            name, unit = dialect.speed.values_named[key], "m" if key == "stroke_value" else "Hz"
            own[f"{name}_{unit}"] = float(values[first])
        _by_strokes(part, own, time[first:stop], where, dialect)
        steps.append(own)
        mean_speed[first:stop] = 2 * own["stroke_m"] * own["stroke_frequency_Hz"]
        if "sliding_velocity" not in part:
            without.append((first, stop - 1, own["stroke_frequency_Hz"]))
            velocity[first:stop] = np.nan
        else:
            velocity[first:stop] = part["sliding_velocity"]
    if not steps:
        raise ReadError("its strokes have a frequency or a length of zero all along", where=where)
    attrs["stroke_m"] = max(own["stroke_m"] for own in steps)
    if unlike := sum(own.get("strokes_unlike_s", 0.0) for own in steps):
        attrs["strokes_unlike_s"] = unlike
    for key in ("stroke_m", "stroke_frequency_Hz"):
        attrs[f"{key}_of_steps"] = "; ".join(f"{own[key]:.6g}" for own in steps)
    if len(without) == len(steps):
        columns["set_speed"] = mean_speed
        return
    for first, last, frequency in without:
        # a shorter step may show no reversal
        if (time[last] - time[first]) * frequency >= FEWEST_CYCLES:
            raise ReadError(
                f"the friction from {time[first]:.4g} to {time[last]:.4g} s does not turn over "
                f"with the {frequency:.4g} Hz that are stated for it",
                where=where,
            )
    columns["sliding_velocity"] = velocity


def _changes_with_steps(step: np.ndarray | None, bounds: np.ndarray) -> bool:
    """Whether step numbers change at every change of a setting."""
    inner = bounds[1:-1]
    return step is not None and bool((step[inner] != step[inner - 1]).all())


def level_of_each(values: np.ndarray) -> np.ndarray | None:
    """Return the level of each value of a stepwise setting; None if it is not stepwise.

    Parameters
    ----------
    values
        Setting or its reading, zero at rest (time).

    Returns
    -------
    numpy.ndarray or None
        Median of the level of each value, 0 if it is zero or unknown. None for a ramp, whose levels
        are not separated.

    Examples
    --------
    >>> level_of_each(np.array([0.0, 1.0, 1.02, 0.98, 2.0, 2.01])).tolist()
    [0.0, 1.0, 1.0, 1.0, 2.005, 2.005]
    >>> level_of_each(np.linspace(1, 2, 50)) is None
    True
    """
    moving = np.isfinite(values) & (values > 0)
    ordered = np.unique(values[moving])
    if not ordered.size:
        return None
    apart = np.flatnonzero(np.diff(ordered) > _VARIES * ordered[:-1])
    lowest = ordered[np.append(0, apart + 1)]
    of_level = np.searchsorted(lowest, values, side="right") - 1
    result = np.zeros(len(values))
    for level in range(lowest.size):
        mine = moving & (of_level == level)
        middle = float(median(values[mine]))
        if np.any(np.abs(values[mine] / middle - 1) > _VARIES):
            return None
        result[mine] = middle
    return result


_VARIES = 0.1  # relative variation of one setting; magnetic drives control it to some per cent
_SIGNALS = ("friction_force", "friction_coefficient", "shear_stress")


def _stated(text: str | None, value: str | None, unit: str, attrs: Json) -> float | None:
    """Return a radius, stroke or frequency stated in the dialect, or by a value of the file."""
    if text is not None:
        return to_si(text, unit, "speed")
    number = attrs.get(f"{value}_{unit}") if value else None
    return float(number) if isinstance(number, float | int) else None
