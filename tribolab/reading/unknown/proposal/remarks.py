"""Comments in a drafted dialect: guesses, unused columns and values, and missing inputs."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tribolab.reading.dialect.write import FILL_IN, Remarks, comment, commented, table_lines
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.derivations.model import SAYS_FRICTION
from tribolab.reading.unknown.model import DraftColumn, Reason
from tribolab.reading.unknown.proposal.dialect import (
    Described,
    column_content,
    formula_content,
    value_content,
)
from tribolab.units.quantities import quantity

_REMOVE = "then remove the '#' below"
_RATE = ['source = "rate"', 'rate = "? Hz"']
_RADIUS = ['source = "rotation"', 'radius = "? mm"']
_CRANK = ['source = "stroke"', 'stroke = "? mm"', 'frequency = "? Hz"']
_ON_REPEAT = {
    "drop": "rows that repeat the one before are left out",
    "interpolate": "guessed: rows that are not later get times between",
}


def remarks_of(described: Described) -> Remarks:
    """Return the comments of a drafted dialect, by the place where they are written."""
    layout, understood, follows, stated, _ = described
    read = [*described.columns, *(column for _, column in follows.symbols)]
    above = {f"column.{n}": _about_column(c) for n, c in enumerate(read)}
    about = (f"guessed: {value.guess}" if value.guess else value.text for value in stated)
    above |= {f"value.{n}": _lines([text]) for n, text in enumerate(about)}
    above |= {f"derived.{n}": _lines([f.about]) for n, f in enumerate(follows.formulas)}
    file = comment(layout.file.path.name)
    above[""] = _lines([f"Drafted from '{file}'. Look at what is marked 'guessed'."])
    if follows.speed is not None and follows.speed.guess:
        above["speed"] = _lines([f"guessed: {follows.speed.guess}"])
    below = {
        "": (*_lines(_about_file(described)), *_pitch(described)),
        "time": _sample_rate(described),
        "speed": _rotation(described),
        "column": tuple(_columns_not_read(described)),
        "value": tuple(_values_not_used(described)),
        "derived": tuple(_missing_formulas(described)),
    }
    return Remarks(above, below, _behind(described))


def _lines(texts: Iterable[str]) -> tuple[str, ...]:
    return tuple(f"# {comment(text)}" for text in texts)


def _about_file(described: Described) -> list[str]:
    layout, understood = described.layout, described.understood
    said = [f"guessed: {g}" for g in (*layout.notes, *layout.guesses, *understood.guesses)]
    more = f"{layout.others} more tables are in the file; they are not read"
    return [*said, more] if layout.others else said


def _pitch(described: Described) -> list[str]:
    understood = described.understood
    if understood.kind != "scan" or understood.pitched:
        return []
    if any(column.quantity == "x" for column in understood.columns):
        return []
    about = f"the distance of neighbouring heights, {_REMOVE}"
    return [f"# {FILL_IN}: {about}", '# pitch = "? um"']


def _behind(described: Described) -> dict[str, str]:
    understood = described.understood
    return {
        "pitch_value": "its heights have no positions",
        "length_value": "its heights have no positions",
        "time.epoch": "tells when it was recorded",
        "time.on_repeat": _ON_REPEAT.get(understood.on_repeat, ""),
        "time.restart": "the clock restarts or wraps",
        "rows.are": "each row is the mean at one speed, its error unknown",
        "time.source": _source_of_time(described),
    }


def _source_of_time(described: Described) -> str:
    if described.understood.period:
        return "the column contains the time since the row before"
    return "guessed: rows are counted as seconds" if _rows_are_counted(described) else ""


def _rows_are_counted(described: Described) -> bool:
    understood = described.understood
    timed = any(c.used and c.quantity == "time" for c in understood.columns)
    known = timed or understood.rate_pattern or understood.rate or understood.points
    return understood.kind == "run" and not known


def _sample_rate(described: Described) -> tuple[str, ...]:
    if not _rows_are_counted(described):
        return ()
    about = f"# {FILL_IN}: if the sample rate is known, put it in instead:"
    return (about, *commented(_RATE))


def _rotation(described: Described) -> tuple[str, ...]:
    """Return proposed settings, as comments, for a speed that is still unknown."""
    understood = described.understood
    names = {column.quantity for column in understood.columns if column.used}
    if described.follows.speed is not None or understood.kind != "run":
        return ()
    if names & {"sliding_velocity", "position"}:
        return ()
    if {c.quantity for c in understood.columns if c.fill_in} & {"position", "sliding_velocity"}:
        return ('# "position" or "column", once that column (below) has its unit',)
    if "rotation_speed" not in names:
        return ()
    if "crank" in described.follows.facts:
        about = "the stroke of the crank, and how often it turns"
        return (f"# {FILL_IN}: {about}", *commented(_CRANK))
    about = "the radius of the track, if the disc's rotation tells the speed"
    return (f"# {FILL_IN}: {about}", *commented(_RADIUS))


def _about_column(column: DraftColumn) -> tuple[str, ...]:
    note = [column.note] if column.used and column.note else []
    return _lines([*(f"guessed: {guess}" for guess in column.guessed), *note])


def _columns_not_read(described: Described) -> list[str]:
    """Return comments on the columns that are not used; empty columns share one line."""
    understood, numbers = described.understood, described.understood.numbers
    waiting = [column for column in understood.columns if column.fill_in]
    parts = [_proposed(column, numbers) for column in waiting]
    taken = {column.place for _, column in described.follows.symbols}
    torque = torque_of(understood.columns) if understood.kind == "run" else None
    taken |= {torque.place} if torque is not None else set()  # `_missing_formulas` proposes it
    rest = [c for c in understood.columns if not (c.used or c.fill_in or c.place in taken)]
    filled = np.isfinite(numbers).any(axis=0)
    empty = [c for c in rest if not (c.label or filled[c.place - 1] or c.note)]
    unknown = [c for c in rest if c.label and not c.quantity and c.reason is Reason.UNKNOWN_NAME]
    others = [c for c in rest if c not in empty and c not in unknown]
    if others:
        parts.append("# Not used. To use a column remove the '#' before it and put in what is '?'.")
        parts += [_proposed(column, numbers) for column in others]
    if unknown:
        listed = [f"#   {c.place} '{comment(c.label)}': {_range(c, numbers)}" for c in unknown]
        parts.append("\n".join(["# Not used, their names are not known: column", *listed]))
    if empty:
        parts.append(f"# Empty: column {', '.join(str(c.place) for c in empty)}")
    return parts


def _proposed(column: DraftColumn, numbers: np.ndarray) -> str:
    """Return the [[column]] entry of an unused column as a comment, ready to be filled in."""
    if column.fill_in:
        about = [f"{FILL_IN}: {column.fill_in}, {_REMOVE}"]
        about += [f"guessed: {guess}" for guess in column.guessed]
    else:
        label = f" '{column.label}'" if column.label else ""
        note = column.note or "not used"
        about = [f"column {column.place}{label}: {_range(column, numbers)}; {note}"]
    content = {"quantity": "?"} | column_content(column)
    pure = column.quantity is not None and quantity(column.quantity).unit == "1"
    if column.unit is None and column.file_unit is None and not pure:
        content["unit"] = "?"
    return "\n".join([*_lines(about), *commented(table_lines("[[column]]", content, {}))])


def _range(column: DraftColumn, numbers: np.ndarray) -> str:
    values = numbers[:, column.place - 1]
    finite = values[np.isfinite(values)]
    if not finite.size:
        return "no number"
    return " to ".join(dict.fromkeys(f"{end:.6g}" for end in (finite.min(), finite.max())))


def _values_not_used(described: Described) -> list[str]:
    if not described.proposed:
        return []
    parts = ["# Single values that the file states. To keep one, remove the '#' before it."]
    for value in described.proposed:
        lines = commented(table_lines("[[value]]", value_content(value), {}))
        parts.append("\n".join([*_lines([value.text]), *lines]))
    return parts


def _missing_formulas(described: Described) -> list[str]:
    """Return entries, as comments, that a coefficient of friction still needs."""
    understood = described.understood
    torque = torque_of(understood.columns) if understood.kind == "run" else None
    parts = []
    if torque is not None and not described.known & SAYS_FRICTION:
        column = table_lines("[[column]]", column_content(torque, "torque"), {})
        formula = formula_content("friction_force", "torque / '? mm'")
        rule = table_lines("[[derived]]", formula, {})
        about = f"the radius at which the torque's friction acts, {_REMOVE}"
        parts.append("\n".join([f"# {FILL_IN}: {about}", *commented([*column, "", *rule])]))
    if described.lacks_load and not described.load:
        rule = table_lines("[[derived]]", formula_content("normal_force", "'? N'"), {})
        about = f"the load, if it is one for all of the run, {_REMOVE}"
        parts.append("\n".join([f"# {FILL_IN}: {about}", *commented(rule)]))
    return parts
