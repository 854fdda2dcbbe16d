"""Which column of a table is which quantity, and what turns its numbers into SI."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tribolab.errors import ReadError, UnitError, nearest, shown
from tribolab.io.dialects.model import Column, Dialect
from tribolab.quantities import quantity, unit_conversion


class ReadColumn(NamedTuple):
    """A column that is read: its place (from 0), quantity, unit; ``si = scale * x + offset``."""

    place: int
    quantity: str
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
    """Find the columns that a dialect asks for.

    Parameters
    ----------
    where
        The file's name, for messages.
    names, units
        What the header says; empty in a file without one.
    width
        Number of cells in the first row of numbers.
    dialect
        The dialect.

    Returns
    -------
    tuple
        The columns to read, and the labels of those that are not used.

    Raises
    ------
    ReadError
        If a column is missing or has no usable unit.
    """
    signals = []
    for column in dialect.column:
        index = _index(where, column, names, width, dialect)
        if index is not None:
            signals.append(_signal(where, column, index, names, units, dialect))
    used = {signal.place for signal in signals}
    unused = [
        f"{name} [{unit}]" if unit else name
        for index, (name, unit) in enumerate(zip(names, units, strict=True))
        if index not in used and name
    ]
    if not names:
        unused = [f"column {index + 1}" for index in range(width) if index not in used]
    return signals, unused


def _index(
    where: str, column: Column, names: Sequence[str], width: int, dialect: Dialect
) -> int | None:
    if column.position is not None:
        if column.position <= width:
            return column.position - 1
        if column.optional:
            return None
        raise ReadError(
            f"{where}: column {column.position} ({column.quantity}) is missing, the table has "
            f"{width} columns (instrument '{dialect.name}')"
        )
    places = [index for index, name in enumerate(names) if name == column.name]
    if len(places) >= column.occurrence:
        index = places[column.occurrence - 1]
        if index < width:
            return index
        if not column.optional:
            raise ReadError(
                f"{where}: the header names {len(names)} columns, but the first row of numbers "
                f"has {width}: column '{shown(column.name)}' ({column.quantity}) has no values"
            )
        return None
    if column.optional:
        return None
    if places:
        raise ReadError(
            f"{where}: column '{shown(column.name)}' ({column.quantity}) should stand there "
            f"{column.occurrence} times, it stands {len(places)} times"
        )
    hint = nearest(column.name or "", [name for name in names if name])
    if "did you mean" not in hint and not any(known.name in names for known in dialect.column):
        hint = ""  # no column of this instrument is there: what the file holds is not told
    raise ReadError(
        f"{where}: column '{shown(column.name)}' ({column.quantity}) is missing (instrument "
        f"'{dialect.name}'){hint}"
    )


def _signal(
    where: str,
    column: Column,
    index: int,
    names: Sequence[str],
    units: Sequence[str | None],
    dialect: Dialect,
) -> ReadColumn:
    wanted = quantity(column.quantity).unit
    label = names[index] if names else f"column {index + 1}"
    unit = column.unit if column.unit is not None else (units[index] if units else None)
    if unit is None and wanted not in ("", "1"):
        raise ReadError(
            f"{where}: column '{shown(label)}' has no unit; say it in the dialect "
            f"'{dialect.name}' or a copy of it, e.g. unit = \"{wanted}\" in its [[column]]"
        )
    try:
        scale, offset = unit_conversion(unit or "", column.quantity)
    except UnitError as error:
        raise ReadError(
            f"{where}: column '{shown(label)}' ({column.quantity}): {error}; the right unit can be "
            f"given in the dialect '{dialect.name}'"
        ) from error
    # sign * (scale * x + offset), then the unit
    return ReadColumn(
        place=index,
        quantity=column.quantity,
        label=label,
        unit=unit or "1",
        scale=column.sign * column.scale * scale,
        offset=column.sign * column.offset * scale + offset,
        optional=column.optional,
    )
