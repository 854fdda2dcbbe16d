"""Assignment of a table's columns to quantities, with conversion to SI."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import LacksError, ReadError, UnitError, nearest, shown
from tribolab.reading.dialect.column_rule import Column
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.units.conversion import conversion

AGAIN = "~"  # separates a quantity from the number of its second or later column


class ReadColumn(NamedTuple):
    """Column to be read: index (from 0), key, and conversion ``si = scale * x + offset``.

    The key is its quantity or symbol, with ``~2`` ... for a further column of the same quantity;
    see `first_filled`.
    """

    place: int
    quantity: str
    si_unit: str
    label: str
    unit: str
    scale: float
    offset: float
    optional: bool


def resolve(
    where: str,
    names: Sequence[str],
    units: Sequence[str | None],
    width: int,
    dialect: Dialect,
) -> tuple[list[ReadColumn], list[str]]:
    """Return the columns of a table that a dialect reads, and the labels of all others.

    Raises
    ------
    ReadError
        If columns are missing or have no usable unit; the message names all of them.
    """
    signals: list[ReadColumn] = []
    refused: list[ReadError] = []
    for column in dialect.column:
        try:
            index = _index(column, names, width, dialect)
            if index is not None:
                signal = _signal(column, index, names, units, dialect)
                before = sum(known.quantity.split(AGAIN)[0] == column.key for known in signals)
                key = f"{column.key}{AGAIN}{before + 1}" if before else column.key
                signals.append(signal._replace(quantity=key))
        except ReadError as error:
            refused.append(error)
    if refused:
        lacks = any(isinstance(error, LacksError) for error in refused)
        told = f"{'; '.join(map(str, refused))} (instrument '{dialect.name}')"
        raise (LacksError if lacks else ReadError)(told, where=where)
    used = {signal.place for signal in signals}
    unused = [
        f"{name} [{unit}]" if unit else name
        for index, (name, unit) in enumerate(zip(names, units, strict=True))
        if index not in used and name
    ]
    if not names:
        unused = [f"column {index + 1}" for index in range(width) if index not in used]
    return signals, unused


def symbols(signals: Sequence[ReadColumn], dialect: Dialect) -> dict[str, str]:
    """Return the SI units of the columns that are used only in formulas, by symbol."""
    own = {column.symbol for column in dialect.column if column.symbol}
    return {signal.quantity: signal.si_unit for signal in signals if signal.quantity in own}


def scales_of(signals: Sequence[ReadColumn]) -> dict[str, tuple[float, float]]:
    """Return scale and offset of each column for the conversion to SI."""
    return {signal.quantity: (signal.scale, signal.offset) for signal in signals}


def first_filled(columns: Mapping[str, Sequence[np.ndarray]]) -> dict[str, str]:
    """Return the key of the first filled column for each quantity that has several columns.

    A column is filled if it has a number other than zero; if none is, the first is chosen.
    """
    keys: dict[str, list[str]] = {}
    for key in columns:
        keys.setdefault(key.split(AGAIN)[0], []).append(key)
    chosen = {}
    for name, options in keys.items():
        if len(options) > 1:
            filled = (
                key for key in options if any(np.nan_to_num(part).any() for part in columns[key])
            )
            chosen[name] = next(filled, options[0])
    return chosen


def _index(column: Column, names: Sequence[str], width: int, dialect: Dialect) -> int | None:
    if column.position is not None:
        if column.position <= width:
            return column.position - 1
        if column.optional:
            return None
        raise LacksError(
            f"column {column.position} ({column.key}) is missing, the table has {width} columns"
        )
    called = column.name or f"like {column.name_pattern}"
    places = [index for index, name in enumerate(names) if _is_called(name, column)]
    if len(places) >= column.occurrence:
        index = places[column.occurrence - 1]
        if index < width:
            return index
        if not column.optional:
            raise ReadError(
                f"the header names {len(names)} columns, but the first row of numbers "
                f"has {width}: column '{shown(called)}' ({column.key}) has no values"
            )
        return None
    if column.optional:
        return None
    if places:
        raise ReadError(
            f"column '{shown(called)}' ({column.key}) should stand there "
            f"{column.occurrence} times, it stands {len(places)} times"
        )
    hint = nearest(column.name or "", [name for name in names if name])
    if "did you mean" not in hint and not any(known.name in names for known in dialect.column):
        hint = ""  # the file has no column of this instrument, so its names are not quoted
    raise LacksError(f"column '{shown(called)}' ({column.key}) is missing{hint}")


def _is_called(name: str, column: Column) -> bool:
    if column.name_pattern is None:
        return name == column.name
    return guarded(column.name_pattern).fullmatch(name)


def _signal(
    column: Column,
    index: int,
    names: Sequence[str],
    units: Sequence[str | None],
    dialect: Dialect,
) -> ReadColumn:
    label = names[index] if names else f"column {index + 1}"
    unit = column.unit if column.unit is not None else (units[index] if units else None)
    if column.key == "time" and dialect.time.format:
        unit = "s"  # dates are read in seconds
    wanted = column.si_unit(unit)
    if unit is None and (column.symbol or wanted not in ("", "1")):
        raise ReadError(
            f"column '{shown(label)}' has no unit; say it in the dialect "
            f"'{dialect.name}' or a copy of it, e.g. unit = \"{wanted}\" in its [[column]]"
        )
    try:
        scale, offset = conversion(unit or "", wanted, column.bare)
    except UnitError as error:
        raise ReadError(
            f"column '{shown(label)}' ({column.key}): {error}; the right unit can be "
            "given in the dialect"
        ) from error
    # sign * (scale * x + offset), then the unit; the sign "pressed" is resolved after reading
    sign = 1 if column.sign == "pressed" else column.sign
    return ReadColumn(
        place=index,
        quantity=column.key,
        si_unit=wanted,
        label=label,
        unit=unit or "1",
        scale=sign * column.scale * scale,
        offset=sign * column.offset * scale + offset,
        optional=column.optional,
    )
