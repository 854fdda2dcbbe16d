"""Construction of the dialect that reads a file, from the interpretation of the file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from pydantic import BaseModel

from tribolab.core.errors import ReadError, TribolabError, brief
from tribolab.reading.dialect.column_rule import Column, Value
from tribolab.reading.dialect.file_layout import Header, Text
from tribolab.reading.dialect.model import Derived, Dialect
from tribolab.reading.dialect.time_rule import Time
from tribolab.reading.dialect.write import plain
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.text.dates import has_day
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.model import SAYS_FRICTION, SAYS_LOAD, Follows
from tribolab.reading.unknown.header.profiles import find_pitch, find_profile_length, find_stated
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Understood

_MAX_SETTINGS = 12  # values of a long preamble that are proposed


class Described(NamedTuple):
    """Parts of a dialect for a file: layout, columns, derived quantities and single values.

    `stated` are the single values in the file that the dialect uses, `proposed` the other ones.
    """

    layout: Layout
    understood: Understood
    follows: Follows
    stated: tuple[Amount, ...]
    proposed: tuple[Amount, ...]

    @property
    def columns(self) -> list[DraftColumn]:
        """The columns that are read as quantities."""
        taken = {column.place for _, column in self.follows.symbols}
        return [c for c in self.understood.columns if c.used and c.place not in taken]

    @property
    def load(self) -> str:
        """The load that the user stated, if the file gives none; else ""."""
        return self.understood.load if self.lacks_load else ""

    @property
    def lacks_load(self) -> bool:
        """Whether a run contains friction but no load."""
        columns, known = self.understood.columns, self.known
        if self.understood.kind != "run" or any(column.fill_in for column in columns):
            return False
        held = known & SAYS_FRICTION or torque_of(columns) is not None
        return bool(held) and not known & SAYS_LOAD

    @property
    def known(self) -> set[str]:
        """Quantities of columns, even if the unit is missing, and derived quantities."""
        columns = self.understood.columns
        known = {c.quantity for c in columns if c.quantity and (c.used or c.fill_in)}
        return known | {formula.quantity for formula in self.follows.formulas}


def describe(layout: Layout, understood: Understood) -> Described:
    """Return the parts of a dialect for a file with a given layout and interpretation."""
    follows = what_follows(layout, understood)
    proposed, stated = _values(layout, understood, follows)
    if layout.delimiter == "whitespace":
        layout = layout._replace(
            header_pattern=any_blanks(layout.header_pattern or "") or None,
            step=any_blanks(layout.step or "") or None,
            end=any_blanks(layout.end or "") or None,
        )
        understood = understood._replace(rate_pattern=any_blanks(understood.rate_pattern))
        proposed = [value._replace(pattern=any_blanks(value.pattern)) for value in proposed]
        stated = [value._replace(pattern=any_blanks(value.pattern)) for value in stated]
    used = {value.pattern for value in stated}
    proposed = [value for value in proposed if value.pattern not in used]
    return Described(layout, understood, follows, tuple(stated), tuple(proposed))


def dialect_of(name: str, described: Described) -> Dialect:
    """Return the dialect that reads a file according to its interpretation.

    Raises
    ------
    ReadError
        If no dialect can describe the file.
    """
    layout, understood, follows, stated, _ = described
    held = layout.held
    form = held.form if held is not None else "text"
    formulas = [formula_content(f.quantity, f.formula, f.zero) for f in follows.formulas]
    if described.load:
        formulas.append(formula_content("normal_force", f"'{described.load}'"))
    content = {
        "name": name,
        "title": plain(f"files like {layout.file.path.name}"),
        "format": None if form == "text" else form,
        "recognise": _recognise(described),
        "text": set_keys(Text, {} if held is not None else _text(layout, understood)),
        "header": set_keys(Header, _header(layout) if held is None else _sheet(layout)),
        "time": set_keys(Time, _time(understood)),
        "rows": {"are": "points"} if understood.points else None,
        "speed": _speed(described),
        "pitch": understood.pitch or None,
        "pitch_value": "pitch" if understood.pitch_pattern else None,
        "length_value": "profile_length" if understood.length_pattern else None,
        "column": [
            *map(column_content, described.columns),
            *(column_content(c, symbol) for symbol, c in follows.symbols),
        ],
        "value": [*map(value_content, stated)],
        "derived": formulas,
    }
    try:
        return Dialect.model_validate({key: said for key, said in content.items() if said})
    except (ValueError, TribolabError) as error:
        raise ReadError(
            f"the file was understood, but no dialect can describe it: {brief(error)}",
            where=layout.file.path,
        ) from error


def set_keys(model: type[BaseModel], content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings that differ from the defaults of a model."""
    fields = model.model_fields
    return {key: said for key, said in content.items() if said != fields[key].default}


def column_content(column: DraftColumn, symbol: str = "") -> dict[str, Any]:
    """Return the [[column]] entry of a column, with a symbol for formulas if needed."""
    said = {
        **({"symbol": symbol} if symbol else {"quantity": column.quantity}),
        "name": column.name,
        "position": column.place if column.name is None else None,
        "occurrence": column.occurrence if column.name is not None else 1,
        "group": column.group or None,
        "unit": column.unit,
        "scale": column.scale,
        "offset": column.offset,
        "sign": column.sign,
        "zero": column.zero or None,
        "optional": column.optional,
    }
    return set_keys(Column, said)


def value_content(value: Amount) -> dict[str, Any]:
    """Return the [[value]] entry of a single value."""
    keys = ("name", "source", "pattern", "unit", "scale", "to")
    return set_keys(Value, {key: getattr(value, key) for key in keys})


def formula_content(quantity: str, formula: str, zero: str = "") -> dict[str, Any]:
    """Return the [[derived]] entry of a quantity that follows from others."""
    return set_keys(Derived, {"quantity": quantity, "formula": formula, "zero": zero or None})


def _recognise(described: Described) -> Mapping[str, Any]:
    layout = described.layout
    if not layout.heading:
        return {"columns": layout.width}
    if layout.held is not None and layout.held.form == "tdms":
        return {}  # names of TDMS channels do not identify an instrument
    names = (c.name for c in described.columns if c.name and not c.optional)
    return {"header": tuple(dict.fromkeys(names))}


def _text(layout: Layout, understood: Understood) -> Mapping[str, Any]:
    return {
        "encoding": layout.encoding,
        "delimiter": layout.delimiter,
        "decimal": "," if layout.decimal != "." or layout.quoted else ".",
        "thousands": layout.thousands,
        "missing": understood.missing,
        "end": layout.end or None,
        "skip_lines": layout.skipped,
    }


def _sheet(layout: Layout) -> Mapping[str, Any]:
    held = layout.held
    if held is None or not held.sheet:
        return {}
    units = "row" if held.units_below else "brackets"
    return {"line": held.line, "units": units, "sheet": held.sheet}


def _header(layout: Layout) -> Mapping[str, Any]:
    heading = layout.heading
    if not heading:
        return {"skip": layout.skip}
    units = "row" if heading.units is not None else "brackets"
    units = units if heading.aligned else "dialect"
    between = heading.units - heading.names if heading.units is not None else 0
    return {
        "line": None if layout.header_pattern else layout.header_line,
        "pattern": layout.header_pattern or None,
        "units": units,
        "units_line": max(layout.units_line, 1) if units == "row" else 1,
        "repeats": layout.repeats,
        "step": layout.step or None,
        "skip": layout.skip + (between if units == "dialect" else 0),
    }


def _time(understood: Understood) -> dict[str, Any]:
    clocks = [c for c in understood.columns if c.used and c.quantity == "time"]
    said: dict[str, Any] = {"restart": "continue" if understood.restart else "error"}
    if understood.on_repeat:
        said["on_repeat"] = understood.on_repeat
    for column in (c for c in understood.columns if c.used):
        if column.form:
            said["format"] = column.form
            if not has_day(column.form):
                hours = "%H" in column.form or "%I" in column.form
                said["wrap"] = "24 h" if hours else "60 min"
        elif column.epoch:
            said["epoch"] = column.epoch
    if clocks:
        said["source"] = "period" if understood.period else "column"
    elif understood.rate_pattern:
        paced = converts(understood.rate_unit, "m/s")  # e.g. the speed of a crosshead
        said["source"] = "position" if paced else "rate"
        said |= {"rate_pattern": understood.rate_pattern, "rate_unit": understood.rate_unit}
    elif understood.rate:
        said |= {"source": "rate", "rate": understood.rate}
    else:
        said["source"] = "none"
    return said


def _speed(described: Described) -> Mapping[str, Any]:
    speed = described.follows.speed
    if speed is not None:
        return {"source": speed.source, **dict(speed.settings)}
    names = {column.quantity for column in described.understood.columns if column.used}
    if described.understood.kind == "run" and "sliding_velocity" in names:
        return {}
    with_position = described.understood.kind == "run" and "position" in names
    return {"source": "position" if with_position else "none"}


def _values(
    layout: Layout, understood: Understood, follows: Follows
) -> tuple[list[Amount], list[Amount]]:
    """Return the single values that the file states, and the values that the dialect uses."""
    used = list(follows.values)
    if understood.kind != "scan":
        return list(numeric_settings(layout)), used
    values = list(numeric_settings(layout, bare=True))
    pitch = find_pitch(layout) if understood.pitch_pattern else None
    pitch = find_profile_length(layout) if understood.length_pattern else pitch
    if pitch is not None:
        values = [pitch, *(value for value in values if value.text != pitch.text)]
        used.append(pitch)
    quantities = {column.quantity for column in understood.columns if column.used}
    if "y" not in quantities:
        known = {value.pattern for value in used}
        stated = find_stated(layout, placed="x" in quantities)
        used += [value for value in stated if value.pattern not in known]
    return values[:_MAX_SETTINGS], used


def any_blanks(pattern: str) -> str:
    r"""Return a pattern in which blanks and tabs match any number of blanks and tabs.

    In a table whose cells are separated by blanks, the reader sees one tab for each run of blanks.

    >>> any_blanks(r"^\s*# sample  rate:\s*(\d+)")
    '^\\s*#[ \\t]+sample[ \\t]+rate:\\s*(\\d+)'
    """
    return re.sub(r"(?:(?<!\\) |\\t)+", r"[ \\t]+", pattern)
