"""Changes of a draft: the user's corrections and calibrations, and removal of doubtful columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple, TypeVar

from tribolab.core.errors import ReadError, UnitError, shown
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.clock import find_clock
from tribolab.reading.unknown.model import DraftColumn
from tribolab.reading.unknown.proposal.model import Drafted
from tribolab.units.conversion import conversion
from tribolab.units.quantities import QUANTITIES, quantity

AnyDraft = TypeVar("AnyDraft", bound=Drafted)


def column_of(draft: Drafted, name: str) -> DraftColumn | None:
    """Return the column of a quantity, even if its unit is still unknown; None if there is none."""
    columns = draft.understood.columns if draft.understood else ()
    held = [c for c in columns if c.quantity == name and (c.used or c.fill_in)]
    return held[0] if held else None


def fits(unit: str, name: str) -> bool:
    """Whether a unit has the dimension of a quantity."""
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
    """Return a draft in which the user assigned a column to a quantity.

    Parameters
    ----------
    draft
        From `tribolab.reading.unknown.proposal.draft.draft_dialect`.
    name
        The quantity; or "torque" or "angle", from which a radius gives a friction force or a
        position.
    place
        Number of its column, from 1; None if no column contains it.
    unit
        Unit of the numbers; None if the file states it.
    sign
        -1 if the numbers have the opposite sign.
    scale
        Calibration factor: the number of units per count.

    Raises
    ------
    ReadError
        If there is no such column, or its unit is stated neither here nor in the file.
    """
    layout, before = draft.layout, draft.understood
    if layout is None or before is None:
        raise ReadError("there is no table to correct", where=draft.path)
    if place is not None and not 1 <= place <= len(before.columns):
        raise ReadError(f"there are columns 1 to {len(before.columns)}", where=draft.path)
    columns = []
    for column in before.columns:
        if column.place == place:
            columns.append(_as_described(column, Worth(name, unit or "", scale), sign, draft))
        elif name == "x" and column.quantity == "y" and unit and column.guessed:
            # y of a map has the unit of x
            columns.append(column._replace(unit=unit, guessed=(), options=()))
        elif name in (column.quantity, column.said):
            note = "not this quantity, as was said"
            columns.append(
                column.unused(note, quantity=None, unit=None, sign=1, reason=None, said="")
            )
        else:
            columns.append(column)
    kind = "run" if before.kind == "table" and place is not None else before.kind
    understood = before._replace(kind=kind, columns=tuple(columns))
    if name == "time":
        on_repeat, restart, timed = find_clock(layout, columns, before.numbers)
        understood = understood._replace(columns=tuple(timed), on_repeat=on_repeat, restart=restart)
    return draft.with_understood(understood)


def _as_described(column: DraftColumn, worth: Worth, sign: int, draft: Drafted) -> DraftColumn:
    """Return a column as the user describes it, without guesses."""
    name, unit, scale = worth
    measured = name in QUANTITIES
    read = unit or column.file_unit
    si_unit = si_unit_of(name)
    fitting = read and (fits(read, name) if measured else converts(read, si_unit))
    if not fitting and si_unit != "1":
        raise ReadError(
            f"column {column.place} needs a unit of {name}, e.g. '{si_unit}'", where=draft.path
        )
    return column.unused(
        "",
        used=measured,
        quantity=name if measured else None,
        unit=unit if unit and (unit != column.file_unit or column.name is None) else None,
        sign=sign,
        scale=scale,
        said=name if name in (TORQUE, ANGLE) else "",
    )


_FORCES = {"friction_force", "shear_stress", "normal_force", "normal_stress", "set_normal_force"}
_MOTION = {"position", "rotation_speed", "set_speed", "rolling_speed", "slide_roll_ratio"}


def leave_out_doubtful(draft: AnyDraft) -> tuple[AnyDraft, tuple[str, ...]]:
    """Return a run's draft without doubtful columns that no result needs, and the removed columns.

    A doubtful column is not needed if another column gives the same result with certainty. Time is
    always needed.
    """
    understood = draft.understood
    if understood is None or draft.kind != "run":
        return draft, ()
    certain = {c.quantity for c in understood.columns if c.used and not _is_doubtful(c)}
    out = [c for c in understood.columns if _is_doubtful(c) and not _is_needed(c.quantity, certain)]
    if not out:
        return draft, ()
    columns = [c.unused(f"left out: {_doubt_of(c)}") if c in out else c for c in understood.columns]
    left = tuple(f"'{shown(c.label, 30)}' ({_doubt_of(c)})" for c in out)
    return draft.with_understood(understood._replace(columns=tuple(columns))), left


def _is_doubtful(column: DraftColumn) -> bool:
    return bool(column.guessed or column.fill_in)


def _is_needed(quantity: str | None, certain: set[str | None]) -> bool:
    """Whether results depend on a doubtful quantity, given the quantities that are certain."""
    if quantity in _FORCES:
        return "friction_coefficient" not in certain
    if quantity in _MOTION:
        return "sliding_velocity" not in certain
    if quantity == "friction_coefficient":
        return not {"friction_force", "normal_force"} <= certain
    return quantity in (None, "time", "sliding_velocity", "step", "cycle")


def _doubt_of(column: DraftColumn) -> str:
    if column.guessed:
        others = f", or {', '.join(column.options)}" if column.options else ""
        return f"{'; '.join(column.guessed)}{others}"
    return f"{column.quantity}, unit not stated"


# not quantities of a run, but with a radius they give a friction force and a position
TORQUE: Final = "torque"
ANGLE: Final = "angle"
_NO_QUANTITY = {TORQUE: "N m", ANGLE: "rad"}
_SAID = re.compile(
    r"^\s*([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)?(?:/(\d+(?:[.,]\d+)?)(?=\s*[^\W\d]))?\s*(.*?)\s*$",
    re.DOTALL,
)
_PER = re.compile(r"^(.*\S)\s*(?:/|\bper\b)\s*(\S+)$", re.DOTALL)


class Worth(NamedTuple):
    """Calibration: one count of a column is `scale` times `unit`, a unit of the quantity `name`."""

    name: str
    unit: str
    scale: float = 1.0


def worth_of(text: str, names: Sequence[str], read_unit: str | None = None) -> Worth:
    """Return the calibration that a user's text states: a unit, or a factor with a unit.

    Parameters
    ----------
    text
        ``"mN"``, ``"0.5 mN"`` (per count), ``"1/600 turn"`` or ``"8.2 N/V"``.
    names
        Possible quantities, `TORQUE` or `ANGLE`; the first that has such a unit is taken.
    read_unit
        The unit of the column according to the file.

    Raises
    ------
    UnitError
        If the unit suits none of them.

    Examples
    --------
    >>> worth_of("8,2 N/V", ["friction_force"], "V")
    Worth(name='friction_force', unit='N', scale=8.2)
    >>> worth_of("1/500 turn", ["angle"])
    Worth(name='angle', unit='turn', scale=0.002)
    >>> worth_of("mN m", ["friction_force", "torque"])
    Worth(name='torque', unit='mN m', scale=1.0)
    """
    said = _SAID.match(text)
    number, part, unit = (said[1] or "1", said[2] or "1", said[3]) if said else ("1", "1", text)
    scale = float(number.replace(",", ".")) / float(part.replace(",", "."))
    if (name := _measured(unit, names)) is not None:
        return Worth(name, unit, scale)
    parts = _PER.match(unit)
    if parts and (name := _measured(parts[1], names)) is not None:
        return Worth(name, parts[1], scale * _ratio(read_unit, parts[2]))
    known = " or ".join(f"{name}, e.g. '{si_unit_of(name)}'" for name in names)
    raise UnitError(f"'{shown(text, 40)}' is no unit of {known}, nor an amount of it")


def si_unit_of(name: str) -> str:
    """Return the SI unit of a quantity, of a torque, or of an angle."""
    return _NO_QUANTITY.get(name) or quantity(name).unit


def _measured(unit: str, names: Sequence[str]) -> str | None:
    for name in names:
        bare = quantity(name).bare if name in QUANTITIES else None
        if converts(unit, si_unit_of(name), bare) or (
            si_unit_of(name) == "1" and unit in ("", "1")
        ):
            return name
    return None


def _ratio(read_unit: str | None, per: str) -> float:
    """Return the factor from the column's unit to the unit `per`, e.g. mV to V; 1 for counts."""
    if not read_unit or not converts(read_unit, per):
        return 1.0  # the column is in counts or divisions
    return conversion(read_unit, per)[0]
