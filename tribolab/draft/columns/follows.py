"""What follows from columns and settings where no column holds it: speed, friction, load."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.strokes import (
    END_TO_END,
    FREQUENCY,
    HALF_STROKE,
    STROKE,
    is_frequency,
    is_length,
)
from tribolab.draft.columns.values import DraftValue, find_radius, find_values, key_of, words_said
from tribolab.draft.columns.words import split_unit, squeezed
from tribolab.draft.file.header import converts
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn, Understood
from tribolab.io.dialects.cells import split_name

_TORQUE = re.compile(r"torque|drehmoment|reibmoment|couple|coppia|扭矩|转矩|トルク|^(?:m|mr|tq)$")
_DRIVE = re.compile(
    r"drive|motion|waveform|profile|kinematic|antrieb|bewegung|entrainement|movimento|movimiento"
)
_SINE = re.compile(r"crank|sine|sinus|sinoid|kurbel|eccentric|exzenter|manivelle|scotch")
_EVEN = re.compile(r"triang|constant|linear|konstant|dreieck")
_LOAD = re.compile(
    r"^(?:normal|applied|dead|sled|schlitten|test|axial|static)?"
    r"(?:load|force|weight|mass|gewicht|masse|kraft|last)+$|^(?:normalkraft|auflast|normallast)$"
)
_WEIGHT = {"g": "gf", "kg": "kgf"}
SAYS_SPEED = {"sliding_velocity", "position", "set_speed"}
_SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}


class Formula(NamedTuple):
    """A quantity that follows: its name, the formula, and what it rests on."""

    quantity: str
    formula: str
    about: str


class SpeedBy(NamedTuple):
    """How the sliding speed follows: what [speed] says, by keys, and what of it is guessed."""

    source: str
    settings: tuple[tuple[str, str], ...] = ()
    guess: str = ""
    options: tuple[str, ...] = ()


class Follows(NamedTuple):
    """Formulas, the columns (with their symbols) and values that they need, and the speed."""

    formulas: tuple[Formula, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    values: tuple[DraftValue, ...] = ()
    speed: SpeedBy | None = None


def what_follows(layout: Layout, understood: Understood) -> Follows:
    """Find out what follows of a run where no column holds it.

    Parameters
    ----------
    layout, understood
        What was found out about the file.

    Notes
    -----
    Only what is stated with its unit is used: a torque and the radius of the track; the radius and
    a rotation; rolling speed and slide-to-roll ratio; stroke and frequency; a load or the mass of
    a sled, where no column measures the normal force.
    """
    if understood.kind != "run":
        return Follows()
    # with a unit still to be filled in, a column is there all the same
    names = {c.quantity for c in understood.columns if c.quantity and (c.used or c.fill_in)}
    values = find_values(layout)
    radius = find_radius(values)
    result = Follows()
    if not names & SAYS_SPEED:
        result = _with_speed(result, names, values, understood, words_said(layout))
    if not names & _SAYS_FRICTION and radius is not None:
        torque = _torque(understood.columns)
        if torque is not None:
            formula = Formula("friction_force", f"torque / {radius.name}", "a torque and a radius")
            result = _and(result, formula, [radius], (("torque", torque),))
            names.add("friction_force")
    load = _load(values)
    if load is not None and names & _SAYS_FRICTION and not names & _SAYS_LOAD:
        about = f"nothing measures it: '{load.text}' is taken for all of the run"
        result = _and(result, Formula("normal_force", load.name, about), [load])
    return result


def _and(
    before: Follows,
    formula: Formula,
    values: Sequence[DraftValue] = (),
    symbols: tuple[tuple[str, DraftColumn], ...] = (),
) -> Follows:
    return before._replace(
        formulas=(*before.formulas, formula),
        symbols=(*before.symbols, *symbols),
        values=tuple(dict.fromkeys((*before.values, *values))),
    )


def _with_speed(
    before: Follows,
    names: set[str],
    values: Sequence[DraftValue],
    understood: Understood,
    words: Sequence[tuple[str, str]],
) -> Follows:
    radius = find_radius(values)
    if "rotation_speed" in names and understood.radius:
        return before._replace(speed=SpeedBy("rotation", (("radius", understood.radius),)))
    if "rotation_speed" in names and radius is not None:
        speed = SpeedBy("rotation", (("radius_value", radius.name),))
        return before._replace(speed=speed, values=(*before.values, radius))
    if {"rolling_speed", "slide_roll_ratio"} <= names:
        about = "the slide-to-roll ratio is the sliding speed over the mean speed of both surfaces"
        formula = Formula("sliding_velocity", "slide_roll_ratio * rolling_speed", about)
        return _and(before, formula)._replace(speed=SpeedBy("none"))
    by_values = _of_values(values)
    of_strokes = by_values or _of_columns(understood)
    if of_strokes is None or (by_values is None and "rotation_speed" in names):
        return before
    settings = of_strokes.settings
    said = [text.lower() for key, text in words if _DRIVE.search(squeezed(key))]
    drive, guess = understood.drive or "crank", ""
    options: tuple[str, ...] = ()
    if not understood.drive and any(_EVEN.search(text) for text in said):
        drive = "constant speed"
    elif not understood.drive and not any(_SINE.search(text) for text in said):
        guess, options = "a crank drives it: the speed is a sine", ("constant speed",)
    if of_strokes.guess:
        guess = f"{guess}; {of_strokes.guess}" if guess else of_strokes.guess
    speed = SpeedBy("stroke", (*settings, ("drive", drive)), guess, options)
    return before._replace(
        speed=speed,
        values=(*before.values, *of_strokes.values),
        symbols=(*before.symbols, *of_strokes.symbols),
    )


class _Strokes(NamedTuple):
    """Length and frequency of strokes: what [speed] says of them, where they stand, a guess."""

    settings: tuple[tuple[str, str], ...]
    values: tuple[DraftValue, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    guess: str = ""


def _of_values(values: Sequence[DraftValue]) -> _Strokes | None:
    """Return the length and frequency of strokes that stand above the table."""
    stroke, frequency, guess = _only(values, STROKE, "m"), _only(values, FREQUENCY, "Hz"), ""
    if stroke is None and (half := _only(values, HALF_STROKE, "m")) is not None:
        whole = END_TO_END.search(half.text) is not None
        stroke = half if whole else half._replace(scale=2.0)
        if not whole and "half" not in half.name:
            guess = f"'{half.text}' is half of a stroke"
    if stroke is None or frequency is None:
        return None
    settings = (("stroke_value", stroke.name), ("frequency_value", frequency.name))
    return _Strokes(settings, (stroke, frequency), guess=guess)


def _of_columns(understood: Understood) -> _Strokes | None:
    """Return the columns that hold the length and the frequency of strokes."""
    lengths, frequencies = [], []
    for column in understood.columns:
        name, unit = split_name(column.label)
        unit = column.file_unit or unit
        if unit is not None and converts(unit, "m") and is_length(name):
            lengths.append(column)
        elif is_frequency(name, unit) and not column.used:
            frequencies.append(column)
    if len(lengths) != 1 or len(frequencies) != 1 or lengths[0].used:
        return None
    settings = (("stroke_value", "stroke"), ("frequency_value", "stroke_frequency"))
    return _Strokes(
        settings, symbols=(("stroke", lengths[0]), ("stroke_frequency", frequencies[0]))
    )


def _only(values: Sequence[DraftValue], key: re.Pattern[str], unit: str) -> DraftValue | None:
    """Return the one value of that name and kind; None if there is none, or several."""
    fitting = [
        value
        for value in values
        if value.unit and converts(value.unit, unit) and key.search(squeezed(key_of(value)))
    ]
    return fitting[0]._replace(to=unit) if len(fitting) == 1 else None


def _load(values: Sequence[DraftValue]) -> DraftValue | None:
    """Return the load that the text before the table states, as a force."""
    fitting = []
    for value in values:
        if value.source != "preamble" or not _LOAD.search(squeezed(key_of(value))):
            continue
        unit = _WEIGHT.get(value.own_unit or "", value.own_unit or "")
        if converts(unit, "N"):
            fitting.append(value._replace(name="set_normal_force", unit=unit, to=None))
    return fitting[0] if len(fitting) == 1 else None


def _torque(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the one column that holds a torque."""
    fitting = []
    for column in columns:
        name, unit = split_name(column.label)
        if unit is None and column.file_unit is None:
            name, unit = split_unit(name)
        unit = column.file_unit or unit or ""
        if _TORQUE.search(squeezed(name)) and converts(unit, "N m"):
            own = None if column.file_unit and column.name is not None else unit
            fitting.append(column._replace(unit=own))
    return fitting[0] if len(fitting) == 1 else None
