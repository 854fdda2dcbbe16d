"""Rule of a dialect for profiles with heights but no positions."""

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
    """Raise if a pitch cannot define positions.

    Raises
    ------
    ValueError
        If several are given, positions exist, heights are missing, or the value does not exist.
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
