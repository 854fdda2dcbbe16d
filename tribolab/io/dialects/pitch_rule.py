"""What a dialect says of a profile whose file holds heights without positions."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.errors import shown
from tribolab.io.dialects.value_rule import Value
from tribolab.units import positive


def check_pitch(
    pitch: str | None, held_by: str | None, values: Sequence[Value], columns: Sequence[str]
) -> None:
    """Refuse a pitch that stands for no positions.

    Parameters
    ----------
    pitch, held_by
        The distance of neighbouring points, or the name of the value that holds it.
    values
        The dialect's values.
    columns
        Quantities of its columns.

    Raises
    ------
    ValueError
        If both are given, there are positions already, or no heights, or no such value.
    """
    if pitch is None and held_by is None:
        return
    if pitch is not None and held_by is not None:
        raise ValueError("give either pitch or pitch_value, not both")
    if "height" not in columns or "x" in columns or "y" in columns:
        raise ValueError("pitch is for a column of 'height' without one of 'x'")
    if pitch is not None:
        positive(pitch, "m", "pitch")
    elif not any(v.name == held_by and v.unit is not None and v.si_unit == "m" for v in values):
        raise ValueError(
            f"pitch_value: there is no value '{shown(str(held_by))}' with a unit and to = 'm'"
        )
