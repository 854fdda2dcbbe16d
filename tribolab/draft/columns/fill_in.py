"""A column whose quantity is known: its unit and sign, what of it is a guess, what is left open."""

from __future__ import annotations

import re

import numpy as np

from tribolab.draft.columns.epochs import DATES, counted_from
from tribolab.draft.model import DraftColumn, Kind, other_units, time_unit
from tribolab.errors import shown
from tribolab.quantities import quantity
from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_count
from tribolab.reading.lexicon.lexicon import normalise_label, role_of

Bare = tuple[str, str | None, bool]  # a name without its unit, the unit, whether it is to be said
FORCES = {"friction_force", "normal_force", "friction_coefficient"}  # what a coefficient is made of
_NOISE = 0.1  # of the highest load, what a sensor without a load shows
_BRACKETS = re.compile(r"[\[(]\s*([^\W\d][^\])]{0,19})[\])]\s*$")  # a unit stands there, if any
_FACTOR = re.compile(
    r"[x×*·]?\s?\b10\s?\^\s?-?\d+|[x×*·]\s?1(?:0+|[eE][+-]?\d+)(?!\d)", re.IGNORECASE
)
# beside friction: which column is taken for such a quantity changes no coefficient of friction
_ASIDE = {"temperature", "ambient_pressure", "voltage", "height_displacement"}


def filled_in(
    column: DraftColumn,
    bare: Bare,
    option: Match,
    values: np.ndarray,
    kind: Kind,
    several: bool,
) -> DraftColumn:
    """Return a column as one that holds a quantity.

    Parameters
    ----------
    column, bare
        The column, and its name without the unit.
    option
        The quantity that its name stands for.
    values
        Its numbers as written (row).
    kind
        What the file is.
    several
        Whether other columns' names suit the quantity as well.
    """
    _, unit, say_unit = bare
    si_unit = quantity(option.quantity).unit
    guessed = []
    options: tuple[str, ...] = ()
    if option.score < KNOWN_WORD and option.quantity not in _ASIDE:
        guessed.append(f"the name means {quantity(option.quantity).long_name}")
    if several and option.quantity not in _ASIDE:
        guessed.append(f"of several columns for {option.quantity} it is the one meant")
    written = unit if say_unit else None
    if option.unit:
        written = option.unit
    if option.unit and kind != "scan":
        guessed.append(f"'{shown(unit)}' means {option.unit}")
    fill_in = unsaid = ""
    dated = normalise_label(bare[0]) in DATES
    counted = (
        counted_from(values, unit, dated=dated)
        if option.quantity == "time" and not column.counted
        else None
    )
    if role_of(bare[0]) == "extreme" and option.quantity in FORCES:
        guessed.append("by its name it is not the signal but its extremes or scatter")
    factor = _FACTOR.search(column.label)
    if factor and factor[0].lstrip("x×*· ") not in (unit or ""):  # the unit's own is read
        guessed.append(f"'{factor[0]}' in its name changes no number")
    if unit is not None and is_count(unit):
        fill_in = f"what one count of '{shown(column.label)}' ({option.quantity}) is, e.g. "
        fill_in += f'"0.5 m{si_unit}"'
    elif unit is None and si_unit not in ("", "1"):
        stands = _BRACKETS.search(column.label)
        why = f", for '{shown(stands[1])}' is no unit that is known" if stands else ""
        if counted is not None:
            written = counted.unit
        elif option.quantity == "time":
            written = time_unit(values)
            guessed.append(f"time is in {written}{why}")
            options = other_units("s", written)
        elif kind == "scan":
            written = "mm" if option.quantity in ("x", "y") else "um"
            guessed.append(f"{option.quantity} is in {written}{why}")
            options = other_units("height" if option.quantity == "height" else "m", written)
        elif option.quantity in _ASIDE and kind == "run":
            written, unsaid = None, f"{option.quantity}? its unit is not said"
        else:
            fill_in = f"the unit of '{shown(column.label)}' ({option.quantity}), e.g. \"{si_unit}\""
            options = other_units(si_unit)
    finite = values[np.isfinite(values)]
    sign = 1
    # noise about zero before the contact is loaded may have the other sign
    pressed = finite.size and finite.min() < 0 and finite.max() < _NOISE * -finite.min()
    if option.quantity == "normal_force" and pressed:
        sign = -1  # no contact slides under a pull all along
    used, note = not (fill_in or unsaid), unsaid
    if option.quantity == "position" and finite.size > 2 and np.ptp(finite) == 0:
        used, note, fill_in = False, "it stands still", ""
    return column._replace(
        quantity=option.quantity,
        unit=written,
        sign=sign,
        optional=not finite.size and option.quantity != "time",
        used=used and (bool(finite.size) or option.quantity != "time"),
        guessed=tuple(guessed),
        options=options,
        note=note or ("" if finite.size else "no value in this file"),
        fill_in=fill_in,
        epoch=counted.epoch if counted is not None else "",
    )
