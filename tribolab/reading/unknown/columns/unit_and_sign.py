"""Unit and sign of a column whose quantity is known, with guesses and open questions."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_count, is_date
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, role_of
from tribolab.reading.unknown.columns.cells import counted_from
from tribolab.reading.unknown.model import DraftColumn, Kind, other_units, time_unit
from tribolab.units.quantities import quantity

Bare = tuple[str, str | None, bool]  # name, unit, whether the dialect must state the unit
FORCES = {"friction_force", "normal_force", "friction_coefficient"}  # give µ
IN_SECONDS = "time is in s"  # guess for a clock without a unit
_NOISE = 0.1  # noise of an unloaded sensor as a share of the highest load, at most
_BRACKETS = re.compile(r"[\[(]\s*([^\W\d][^\])]{0,19})[\])]\s*$")  # usually a unit
_FACTOR = re.compile(
    r"[x×*·]?\s?\b10\s?\^\s?-?\d+|[x×*·]\s?1(?:0+|[eE][+-]?\d+)(?!\d)", re.IGNORECASE
)
# quantities on which no coefficient of friction depends, so that nothing is asked about them
_ASIDE = {"temperature", "ambient_pressure", "voltage", "height_displacement"}


def filled_in(
    column: DraftColumn,
    bare: Bare,
    option: Match,
    values: np.ndarray,
    kind: Kind,
    several: bool,
) -> DraftColumn:
    """Return a column with its quantity, unit and sign, and the guesses about them.

    Parameters
    ----------
    column, bare
        The column, and its name without the unit.
    option
        The quantity, and how well the name suits it.
    values
        Its numbers as written (row).
    kind
        Whether the file is a run, a scan or another table.
    several
        Whether other columns' names suit the quantity as well.
    """
    name = option.quantity
    reading = _unit_reading(column, bare, option, values, kind)
    finite = values[np.isfinite(values)]
    used, note, fill_in = not (reading.fill_in or reading.note), reading.note, reading.fill_in
    if name == "position" and finite.size > 2 and np.ptp(finite) == 0:
        used, note, fill_in = False, "it is constant", ""
    return column._replace(
        quantity=name,
        unit=reading.unit,
        sign=-1 if name == "normal_force" and _is_negative_load(finite) else 1,
        optional=not finite.size and name != "time",
        used=used and (bool(finite.size) or name != "time"),
        guessed=(*_doubts_of_name(column, bare, option, kind, several=several), *reading.guessed),
        options=reading.options,
        note=note or ("" if finite.size else "no value in this file"),
        fill_in=fill_in,
        epoch=reading.epoch,
    )


class _Reading(NamedTuple):
    """Unit in which a column is read, guesses about it, and what the user has to fill in."""

    unit: str | None
    guessed: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    fill_in: str = ""
    note: str = ""
    epoch: str = ""


def _is_negative_load(values: np.ndarray) -> bool:
    """Whether a load is recorded as negative, apart from noise before contact."""
    return bool(values.size) and values.min() < 0 and values.max() < _NOISE * -values.min()


def _doubts_of_name(
    column: DraftColumn, bare: Bare, option: Match, kind: Kind, *, several: bool
) -> list[str]:
    """Return what the user has to confirm about the name of a column."""
    name, unit, _ = bare
    aside, doubts = option.quantity in _ASIDE, []
    if option.score < KNOWN_WORD and not aside:
        doubts.append(f"the name means {quantity(option.quantity).long_name}")
    if several and not aside:
        doubts.append(f"of several columns for {option.quantity} it is the one meant")
    # a load in grams is certainly a dead weight
    weight = option.quantity == "normal_force" and key_pattern("load").search(normalise_label(name))
    if option.unit and not weight and kind != "scan":
        doubts.append(f"'{shown(unit)}' means {option.unit}")
    if role_of(name) == "extreme" and option.quantity in FORCES:
        doubts.append("by its name it is not the signal but its extremes or scatter")
    factor = _FACTOR.search(column.label)
    if factor and factor[0].lstrip("x×*· ") not in (unit or ""):  # a factor in the unit is applied
        doubts.append(f"'{factor[0]}' in its name changes no number")
    return doubts


def _unit_reading(
    column: DraftColumn, bare: Bare, option: Match, values: np.ndarray, kind: Kind
) -> _Reading:
    """Return the unit in which a column is read, or what is missing to determine it."""
    name, unit, say_unit = bare
    si_unit, label = quantity(option.quantity).unit, shown(column.label)
    timed = option.quantity == "time"
    counted = None
    if timed and not column.counted:
        counted = counted_from(values, unit, dated=is_date(name))
    epoch = counted.epoch if counted is not None else ""
    written = option.unit or (unit if say_unit else None)
    if unit is not None and is_count(unit):
        what = f"what one count of '{label}' ({option.quantity}) is, e.g. \"0.5 m{si_unit}\""
        return _Reading(written, fill_in=what, epoch=epoch)
    if unit is not None or si_unit in ("", "1"):
        return _Reading(written, epoch=epoch)
    if counted is not None:
        return _Reading(counted.unit, epoch=epoch)
    bracket = _BRACKETS.search(column.label)
    why = f", for '{shown(bracket[1])}' is no unit that is known" if bracket else ""
    if timed or kind == "scan":
        written = _likely_unit(option.quantity, values)
        of = "s" if timed else "height" if option.quantity == "height" else "m"
        guess = f"{option.quantity} is in {written}{why}"
        return _Reading(written, (guess,), other_units(of, written))
    if option.quantity in _ASIDE and kind == "run":
        return _Reading(None, note=f"{option.quantity}? its unit is not said")
    what = f"the unit of '{label}' ({option.quantity}), e.g. \"{si_unit}\""
    return _Reading(written, options=other_units(si_unit), fill_in=what)


def _likely_unit(name: str, values: np.ndarray) -> str:
    if name == "time":
        return time_unit(values)
    return "mm" if name in ("x", "y") else "um"
