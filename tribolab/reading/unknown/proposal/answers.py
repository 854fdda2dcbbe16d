"""A draft as a person corrects it: which column is what, in which unit, counted how."""

from __future__ import annotations

from typing import TypeVar

from tribolab.core.errors import ReadError
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.unknown.columns.clock import find_clock
from tribolab.reading.unknown.model import DraftColumn
from tribolab.reading.unknown.proposal.calibration_factor import ANGLE, TORQUE, Worth, si_unit_of
from tribolab.reading.unknown.proposal.model import Drafted
from tribolab.units.quantities import QUANTITIES, quantity

AnyDraft = TypeVar("AnyDraft", bound=Drafted)


def column_of(draft: Drafted, name: str) -> DraftColumn | None:
    """Return the column of a quantity, even if its unit is still unknown."""
    columns = draft.understood.columns if draft.understood else ()
    held = [c for c in columns if c.quantity == name and (c.used or c.fill_in)]
    return held[0] if held else None


def fits(unit: str, name: str) -> bool:
    """Whether a quantity can be written in a unit."""
    known = quantity(name)
    return converts(unit, known.unit, known.bare)


def corrected(
    draft: AnyDraft,
    name: str,
    place: int | None,
    unit: str | None = None,
    sign: int = 1,
    *,
    scale: float = 1.0,
) -> AnyDraft:
    """Return a draft with a column assigned to a quantity by a person.

    Parameters
    ----------
    draft
        From `tribolab.reading.unknown.proposal.draft.draft_dialect`.
    name
        The quantity; or "torque" or "angle", which a radius makes a friction force or
        a position.
    place
        Number of its column, from 1; None without a column.
    unit
        What its numbers are written in; None if the file says it.
    sign
        -1 if it is counted the other way round.
    scale
        How many units one of its numbers is.

    Raises
    ------
    ReadError
        If there is no such column, or its unit is neither given nor said in the file.
    """
    layout, before = draft.layout, draft.understood
    if layout is None or before is None:
        raise ReadError("there is no table to correct", where=draft.path)
    if place is not None and not 1 <= place <= len(before.columns):
        raise ReadError(f"there are columns 1 to {len(before.columns)}", where=draft.path)
    columns = []
    for column in before.columns:
        if column.place == place:
            columns.append(_said(column, Worth(name, unit or "", scale), sign, draft))
        elif name == "x" and column.quantity == "y" and unit and column.guessed:
            columns.append(column._replace(unit=unit, guessed=(), options=()))  # as x, of a map
        elif name in (column.quantity, column.said):
            note = "not this quantity, as was said"
            columns.append(
                column._replace(
                    quantity=None,
                    used=False,
                    guessed=(),
                    fill_in="",
                    unit=None,
                    sign=1,
                    note=note,
                    reason=None,
                    said="",
                )
            )
        else:
            columns.append(column)
    kind = "run" if before.kind == "table" and place is not None else before.kind
    understood = before._replace(kind=kind, columns=tuple(columns))
    if name == "time":
        on_repeat, restart, timed = find_clock(layout, columns, before.numbers)
        understood = understood._replace(columns=tuple(timed), on_repeat=on_repeat, restart=restart)
    return draft.with_understood(understood)


def _said(column: DraftColumn, worth: Worth, sign: int, draft: Drafted) -> DraftColumn:
    """Return a column as a person describes it: nothing of it is a guess."""
    name, unit, scale = worth
    measured = name in QUANTITIES
    read = unit or column.file_unit
    si_unit = si_unit_of(name)
    fitting = read and (fits(read, name) if measured else converts(read, si_unit))
    if not fitting and si_unit != "1":
        raise ReadError(
            f"column {column.place} needs a unit of {name}, e.g. '{si_unit}'", where=draft.path
        )
    return column._replace(
        quantity=name if measured else None,
        unit=unit if unit and (unit != column.file_unit or column.name is None) else None,
        sign=sign,
        scale=scale,
        used=measured,
        said=TORQUE if name == TORQUE else ANGLE if name == ANGLE else "",
        guessed=(),
        options=(),
        fill_in="",
        note="",
    )
