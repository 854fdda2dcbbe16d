"""The sliding speed of a run where no column holds it: by turns, strokes, or the set-point."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.errors import ReadError
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

    Raises
    ------
    ReadError
        If what the speed should follow from is not there.
    """
    source = dialect.speed.source
    if source == "rotation":
        _by_turns(columns, attrs, where, dialect)
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
) -> None:
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

    Raises
    ------
    ReadError
        If such a column does not hold the same all along.
    """
    for key, name in dialect.speed.values_named.items():
        if name not in symbols or name not in columns:
            continue
        values = columns[name]
        values = values[np.isfinite(values) & (values > 0)]
        middle = float(median(values)) if values.size else np.nan
        if values.size and np.any(np.abs(values / middle - 1) > _VARIES):
            raise ReadError(
                f"column '{name}' holds {values.min():.4g} to {values.max():.4g}; a speed that "
                "follows from it needs one number for a run: part the run where it changes",
                where=where,
            )
        turns = key == "frequency_value" and symbols[name].startswith("rad")
        unit = "Hz" if key == "frequency_value" else "m"
        attrs[f"{name}_{unit}"] = middle / (2 * np.pi) if turns else middle


def _by_turns(columns: dict[str, np.ndarray], attrs: Json, where: str, dialect: Dialect) -> None:
    radius = _stated(dialect.speed.radius, dialect.speed.radius_value, "m", attrs)
    if radius is None or "rotation_speed" not in columns:
        raise ReadError(
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
        raise ReadError(
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


_VARIES = 0.1  # relative; the stroke of a magnetic drive is controlled to some per cent
_SIGNALS = ("friction_force", "friction_coefficient", "shear_stress")


def _stated(text: str | None, value: str | None, unit: str, attrs: Json) -> float | None:
    """Return what a dialect says itself, or the value beside the table that it names."""
    if text is not None:
        return to_si(text, unit, "speed")
    number = attrs.get(f"{value}_{unit}") if value else None
    return float(number) if isinstance(number, float | int) else None
