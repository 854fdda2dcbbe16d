"""What a dialect says of a profile whose file holds heights without positions."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.core.errors import shown
from tribolab.reading.dialect.value_rule import Value
from tribolab.units.conversion import positive


def check_pitch(
    pitch: str | None,
    pitch_value: str | None,
    length_value: str | None,
    values: Sequence[Value],
    columns: Sequence[str],
) -> None:
    """Refuse a pitch that stands for no positions.

    Parameters
    ----------
    pitch
        The distance of neighbouring points.
    pitch_value, length_value
        Names of the values that hold it, or the length of the whole profile.
    values
        The dialect's values.
    columns
        Quantities of its columns.

    Raises
    ------
    ValueError
        If several are given, there are positions already, or no heights, or no such value.
    """
    keys = {"pitch": pitch, "pitch_value": pitch_value, "length_value": length_value}
    given = {key: text for key, text in keys.items() if text is not None}
    if not given:
        return
    if len(given) > 1:
        raise ValueError(f"give either {' or '.join(given)}, not all of them")
    if "height" not in columns or "x" in columns or "y" in columns:
        raise ValueError("pitch is for a column of 'height' without one of 'x'")
    [(key, text)] = given.items()
    if key == "pitch":
        positive(text, "m", "pitch")
    elif not any(v.name == text and v.unit is not None and v.si_unit == "m" for v in values):
        raise ValueError(f"{key}: there is no value '{shown(text)}' with a unit and to = 'm'")
