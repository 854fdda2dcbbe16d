"""The sliding speed of a run where no column holds it: by turns, strokes, or the set-point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.errors import LacksError, ReadError
from tribolab.io.dialects.model import Dialect
from tribolab.io.stroke_speed import velocity_of_strokes
from tribolab.medians import median
from tribolab.units import to_si
from tribolab.untyped import Json


def add_speed(
    columns: dict[str, np.ndarray],
    attrs: Json,
    time: np.ndarray,
    where: str,
    dialect: Dialect,
    of_steps: Mapping[str, np.ndarray] | None = None,
) -> None:
    """Add the sliding speed as the dialect says that it comes about; nothing is invented.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time); the speed is added.
    attrs
        Attributes of the run, which hold the values beside the table; added to.
    time
        [s] (time).
    where
        The run, for messages.
    dialect
        The instrument's dialect.
    of_steps
        From `keep_settings`.

    Raises
    ------
    ReadError
        If what the speed should follow from is not there.
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
    """Keep what columns say of a radius, a stroke or a frequency, before they are used up.

    Parameters
    ----------
    columns
        Arrays in SI by quantity or symbol (time).
    symbols
        SI units of the symbols.
    attrs
        Attributes of the run; added to.
    where
        The run, for messages.
    dialect
        The instrument's dialect.

    Returns
    -------
    dict
        What the text before the steps says differently from step to step, in SI (time), by the
        key of ``[speed]``.

    Raises
    ------
    ReadError
        If such a column does not hold the same all along, or a step does not state what others do.
    """
    before_steps = {v.name: v.si_unit for v in dialect.value if v.source in _OF_STEPS and v.unit}
    of_steps: dict[str, np.ndarray] = {}
    for key, name in dialect.speed.values_named.items():
        if name not in {*symbols, *before_steps} or name not in columns:
            continue
        values, symbol_unit = columns[name], symbols.get(name) or before_steps[name]
        if name in before_steps and np.any(values != values[0]):
            of_steps[key] = _of_each_step(values, name, symbol_unit, where)
            continue
        values = values[np.isfinite(values) & (values > 0)]
        middle = float(median(values)) if values.size else np.nan
        if values.size and np.any(np.abs(values / middle - 1) > _VARIES):
            raise ReadError(
                f"column '{name}' holds {values.min():.4g} to {values.max():.4g}; a speed that "
                "follows from it needs one number for a run: part the run where it changes",
                where=where,
            )
        turns = key == "frequency_value" and symbol_unit.startswith("rad")
        unit = "Hz" if key == "frequency_value" else "m"
        attrs[f"{name}_{unit}"] = middle / (2 * np.pi) if turns else middle
    return of_steps


def _of_each_step(values: np.ndarray, name: str, unit: str, where: str) -> np.ndarray:
    if not np.all(values > 0):
        known = values[values > 0]
        said = f"{known.min():.4g} to {known.max():.4g}" if known.size else "nothing above zero"
        raise ReadError(
            f"'{name}' stands before some steps ({said}) and is missing or zero before others; "
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
    if strokes is None:  # the mean of both ways is known all the same
        attrs["set_speed_m_s"] = 2 * stroke * frequency
        return
    attrs["stroke_frequency_Hz"] = strokes.frequency
    columns["sliding_velocity"] = strokes.velocity


def _by_strokes_of_steps(
    columns: dict[str, np.ndarray],
    attrs: Json,
    time: np.ndarray,
    where: str,
    dialect: Dialect,
    of_steps: Mapping[str, np.ndarray],
) -> None:
    """Take the strokes of each step by themselves, with its own length and frequency."""
    changes = [np.flatnonzero(np.diff(values)) + 1 for values in of_steps.values()]
    bounds = np.unique(np.concatenate([[0], *changes, [len(time)]]))
    velocity = np.zeros(len(time))
    told: list[Json] = []
    for first, stop in zip(bounds[:-1], bounds[1:], strict=True):
        part = {name: columns[name][first:stop] for name in _SIGNALS if name in columns}
        own = dict(attrs)
        for key, values in of_steps.items():
            name, unit = dialect.speed.values_named[key], "m" if key == "stroke_value" else "Hz"
            own[f"{name}_{unit}"] = float(values[first])
        _by_strokes(part, own, time[first:stop], where, dialect)
        told.append(own)
        if "sliding_velocity" not in part:
            raise ReadError(
                f"the friction from {time[first]:.4g} to {time[stop - 1]:.4g} s does not turn over "
                f"with the {own['stroke_frequency_Hz']:.4g} Hz that the text before it states",
                where=where,
            )
        velocity[first:stop] = part["sliding_velocity"]
    attrs["stroke_m"] = max(own["stroke_m"] for own in told)
    for key in ("stroke_m", "stroke_frequency_Hz"):
        attrs[f"{key}_of_steps"] = "; ".join(f"{own[key]:.6g}" for own in told)
    columns["sliding_velocity"] = velocity


_OF_STEPS = ("step", "programme")  # where a value that each step has is said
_VARIES = 0.1  # relative; the stroke of a magnetic drive is controlled to some per cent
_SIGNALS = ("friction_force", "friction_coefficient", "shear_stress")


def _stated(text: str | None, value: str | None, unit: str, attrs: Json) -> float | None:
    """Return what a dialect says itself, or the value beside the table that it names."""
    if text is not None:
        return to_si(text, unit, "speed")
    number = attrs.get(f"{value}_{unit}") if value else None
    return float(number) if isinstance(number, float | int) else None
