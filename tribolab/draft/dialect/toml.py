"""A drafted dialect as TOML for people: comments say what was guessed and what is missing."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.draft.columns.turning import torque_of
from tribolab.draft.dialect.tables import (
    FILL_IN,
    any_blanks,
    column_table,
    comment,
    formula_table,
    quoted,
    quoted_pattern,
    symbol_table,
    unused_columns,
    value_tables,
)
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.follows import what_follows
from tribolab.draft.follows.model import SAYS_FRICTION, SAYS_LOAD, Follows
from tribolab.draft.model import DraftColumn, Understood
from tribolab.draft.stated.lengths import find_pitch, find_profile_length
from tribolab.draft.stated.settings import Amount, numeric_settings
from tribolab.draft.stated.traces import find_stated
from tribolab.io.dialects.dates import has_day
from tribolab.reading.interpret.unit_texts import converts

_MOST = 12  # values that a long preamble states
_REMOVE = "then remove the '#' below"


def dialect_toml(name: str, layout: Layout, understood: Understood) -> str:
    """Return the TOML text of a dialect that reads a file as it was understood.

    Parameters
    ----------
    name
        Name of the dialect.
    layout, understood
        What was found out about the file.
    """
    follows = what_follows(layout, understood)
    values, taken_over = _values(layout, understood, follows)
    if layout.delimiter == "whitespace":
        layout, understood = _by_any_blanks(layout, understood)
        values = [value._replace(pattern=any_blanks(value.pattern)) for value in values]
        taken_over = [value._replace(pattern=any_blanks(value.pattern)) for value in taken_over]
    columns = understood.columns
    taken = {column.place for _, column in follows.symbols}
    used = [column for column in columns if column.used and column.place not in taken]
    parts = [_head(name, layout, understood)]
    names = dict.fromkeys(c.name for c in used if c.name and not c.optional)
    if layout.heading and names and not _of_groups(layout):
        parts.append("[recognise]\nheader = [" + ", ".join(map(quoted, names)) + "]\n")
    elif not layout.heading:
        parts.append(f"[recognise]\ncolumns = {layout.width}\n")
    parts += [_text_table(layout, understood), _header_table(layout, used)]
    parts += [_time_table(understood), _rows_table(understood)]
    parts.append(_speed_table(understood.kind, columns, follows))
    numbers = understood.numbers
    parts += [column_table(column, numbers[:, column.place - 1]) for column in used]
    parts += [symbol_table(symbol, column) for symbol, column in follows.symbols]
    wanted = [column for column in columns if column.fill_in]
    parts += [column_table(column, numbers[:, column.place - 1]) for column in wanted]
    if understood.kind == "run" and (torque := torque_of(columns)) is not None:
        taken.add(torque.place)  # it stands below, to be filled in
    rest = [c for c in columns if not c.used and not c.fill_in and c.place not in taken]
    parts.append(unused_columns(rest, numbers))
    parts.append(value_tables(values, taken_over))
    parts += [formula_table(formula) for formula in follows.formulas]
    if understood.kind == "run":
        parts += _wanted_tables(understood, follows)
    text = "\n".join(part for part in parts if part)
    return text.encode("utf-8", "replace").decode()  # the file's name may hold any bytes


def _of_groups(layout: Layout) -> bool:
    """Whether columns are channels of groups, which are not known by their names alone."""
    held = layout.held
    return held is not None and held.form == "tdms" and not held.steps


def _values(
    layout: Layout, understood: Understood, follows: Follows
) -> tuple[list[Amount], list[Amount]]:
    """Return the single values that the file states, and those of them that are used."""
    taken_over = list(follows.values)
    if understood.kind != "scan":
        return numeric_settings(layout), taken_over
    values = numeric_settings(layout, bare=True)
    pitch = find_pitch(layout) if understood.pitch_pattern else None
    pitch = find_profile_length(layout) if understood.length_pattern else pitch
    if pitch is not None:
        values = [pitch, *(value for value in values if value.text != pitch.text)]
        taken_over.append(pitch)
    quantities = {column.quantity for column in understood.columns if column.used}
    if "y" not in quantities:
        known = {value.pattern for value in taken_over}
        stated = find_stated(layout, placed="x" in quantities)
        taken_over += [value for value in stated if value.pattern not in known]
    return values[:_MOST], taken_over


def _by_any_blanks(layout: Layout, understood: Understood) -> tuple[Layout, Understood]:
    """Return what was found out with patterns that hold for any number of blanks."""
    return (
        layout._replace(
            header_pattern=any_blanks(layout.header_pattern),
            step=any_blanks(layout.step),
            end=any_blanks(layout.end),
            skip_lines=any_blanks(layout.skip_lines),
        ),
        understood._replace(rate_pattern=any_blanks(understood.rate_pattern)),
    )


def _wanted_tables(understood: Understood, follows: Follows) -> list[str]:
    """Return, as comments to be filled in, what a friction coefficient still needs."""
    known = {column.quantity for column in understood.columns if column.used or column.fill_in}
    known |= {formula.quantity for formula in follows.formulas}
    waiting = any(column.fill_in for column in understood.columns)
    torque = torque_of(understood.columns)
    parts = []
    if torque is not None and not known & SAYS_FRICTION:
        column = symbol_table("torque", torque).splitlines()
        about = "the radius at which the torque's friction acts, " + _REMOVE
        rule = ["", "[[derived]]", 'quantity = "friction_force"', "formula = \"torque / '? mm'\""]
        parts.append(_commented(about, [*column, *rule]))
        known.add("friction_force")
    if known & SAYS_FRICTION and not known & SAYS_LOAD and not waiting:
        about = "the load, if it is one for all of the run, " + _REMOVE
        load = understood.load or "? N"
        rule = ["[[derived]]", 'quantity = "normal_force"', f"formula = \"'{load}'\""]
        # an answer stays where its table waits for another
        parts.append("\n".join(rule) + "\n" if understood.load else _commented(about, rule))
    return parts


def _commented(about: str, lines: Sequence[str]) -> str:
    told = (f"# {line}".rstrip() for line in lines)
    return "\n".join([f"# {FILL_IN}: {about}", *told]) + "\n"


def _head(name: str, layout: Layout, understood: Understood) -> str:
    file = comment(layout.file.path.name)
    lines = [
        f"# Drafted from '{file}'. Look at what is marked 'guessed'.",
        f"name = {quoted(name)}",
        f"title = {quoted('files like ' + file)}",
    ]
    if layout.held is not None:
        lines.append(f'format = "{layout.held.form}"')
    lines += [
        f"# guessed: {comment(guess)}"
        for guess in (*layout.notes, *layout.guesses, *understood.guesses)
    ]
    if understood.pitch:
        lines.append(f"pitch = {quoted(understood.pitch)}")
    elif understood.kind == "scan" and not understood.pitched:
        if not any(column.quantity == "x" for column in understood.columns):
            lines.append(f"# {FILL_IN}: the distance of neighbouring heights, {_REMOVE}")
            lines.append('# pitch = "? um"')
    if understood.pitch_pattern:
        lines.append('pitch_value = "pitch"    # its heights have no positions')
    if understood.length_pattern:
        lines.append('length_value = "profile_length"    # its heights have no positions')
    if layout.others:
        lines.append(f"# {layout.others} more tables stand in the file; they are not read")
    return "\n".join(lines) + "\n"


def _text_table(layout: Layout, understood: Understood) -> str:
    if layout.held is not None:
        return ""
    lines = ["[text]"]
    if layout.delimiter != ",":
        lines.append(f"delimiter = {quoted(layout.delimiter)}")
    if layout.encoding != "utf-8":
        lines.insert(1, f"encoding = {quoted(layout.encoding)}")
    if layout.decimal != "." or layout.quoted:
        lines.append('decimal = ","')
    if layout.arrangement != "below names":
        lines.append(f"arrangement = {quoted(layout.arrangement)}")
    if layout.wrapped:
        lines.append("wrapped = true    # one column: its numbers go on from line to line")
    if layout.thousands:
        lines.append(f"thousands = {quoted(layout.thousands)}")
    if understood.missing:
        lines.append("missing = [" + ", ".join(map(quoted, understood.missing)) + "]")
    if layout.end:
        lines.append(f"end = {quoted_pattern(layout.end)}")
    if layout.skip_lines:
        lines.append(
            f"skip_lines = {quoted_pattern(layout.skip_lines)}    # guessed: the table goes on"
        )
    return "\n".join(lines) + "\n" if len(lines) > 1 else ""


def _header_table(layout: Layout, used: list[DraftColumn]) -> str:
    held = layout.held
    if held is not None:
        if held.steps:
            tables = f"[tables]\nsteps = {quoted_pattern(held.steps)}\n"
            line = f"[header]\nline = {held.line}\n" + ('units = "row"\n' * held.units_below)
            return f"{line}\n{tables}" if held.form == "excel" else tables
        below = 'units = "row"\n' if held.units_below else ""
        sheet = f"[header]\nline = {held.line}\n{below}sheet = {quoted(held.sheet)}\n"
        return sheet if held.sheet else ""
    lines, skip = ["[header]"], layout.skip
    if layout.heading:
        if layout.header_pattern:
            lines.append(f"pattern = {quoted_pattern(layout.header_pattern)}")
        else:
            lines.append(f"line = {layout.header_line}")
        units = "row" if layout.heading.units is not None else "brackets"
        units = units if layout.heading.aligned else "dialect"
        if units == "dialect" and layout.heading.units is not None:
            skip += layout.heading.units - layout.heading.names
        if units != "brackets":
            lines.append(f'units = "{units}"')
        if units == "row" and layout.units_line > 1:
            lines.append(f"units_line = {layout.units_line}")
        if layout.repeats:
            lines.append("repeats = true")
        if layout.step:
            lines.append(f"step = {quoted_pattern(layout.step)}")
    if skip:
        lines.append(f"skip = {skip}")
    return "\n".join(lines) + "\n" if len(lines) > 1 else ""


def _time_table(understood: Understood) -> str:
    lines = ["[time]"]
    for column in understood.columns:
        if column.used and column.form:
            lines.append(f"format = {quoted(column.form)}")
            if not has_day(column.form):
                hours = "%H" in column.form or "%I" in column.form
                lines.append(f'wrap = "{"24 h" if hours else "60 min"}"')
        elif column.used and column.epoch:
            lines.append(f"epoch = {quoted(column.epoch)}    # tells when it was recorded")
    timed = any(c.used and c.quantity == "time" for c in understood.columns)
    if understood.period:
        lines.append('source = "period"    # the column holds what has passed since the row before')
    if not timed and understood.rate_pattern:
        paced = converts(understood.rate_unit, "m/s")  # as fast as a machine goes on
        source = "position" if paced else "rate"
        lines += [
            f'source = "{source}"',
            f"rate_pattern = {quoted_pattern(understood.rate_pattern)}",
        ]
        if understood.rate_unit != "Hz":
            lines.append(f"rate_unit = {quoted(understood.rate_unit)}")
    elif not timed and understood.rate:
        lines += ['source = "rate"', f"rate = {quoted(understood.rate)}"]
    elif not timed:
        lines.append('source = "none"')
        if understood.kind == "run" and not understood.points:
            lines[-1] += "    # guessed: rows are counted as seconds"
            lines.append(f"# {FILL_IN}: if the sample rate is known, put it in instead:")
            lines.append('# source = "rate"\n# rate = "? Hz"')
    if understood.on_repeat == "drop":
        lines.append('on_repeat = "drop"    # rows that repeat the one before are left out')
    elif understood.on_repeat:
        lines.append(
            'on_repeat = "interpolate"    # guessed: rows that are not later get times between'
        )
    if understood.restart:
        lines.append('restart = "continue"    # the clock starts anew, or wraps')
    return "\n".join(lines) + "\n" if len(lines) > 1 else ""


def _rows_table(understood: Understood) -> str:
    points = '[rows]\nare = "points"    # each row is the mean at one speed, its error unknown\n'
    return points if understood.points else ""


def _speed_table(kind: str, columns: Sequence[DraftColumn], follows: Follows) -> str:
    names = {column.quantity for column in columns if column.used}
    if follows.speed is not None:
        lines = ["[speed]", f'source = "{follows.speed.source}"']
        lines += [f"{key} = {quoted(value)}" for key, value in follows.speed.settings]
        if follows.speed.guess:
            lines.insert(1, f"# guessed: {follows.speed.guess}")
        return "\n".join(lines) + "\n"
    if kind == "run" and "sliding_velocity" in names:
        return ""
    source = "position" if kind == "run" and "position" in names else "none"
    lines = ["[speed]", f'source = "{source}"']
    waiting = {column.quantity for column in columns if column.fill_in}
    if source == "none" and kind == "run" and waiting & {"position", "sliding_velocity"}:
        lines.append('# "position" or "column", once that column (below) has its unit')
    elif source == "none" and kind == "run" and "rotation_speed" in names:
        lines.append(
            f"# {FILL_IN}: the radius of the track, if the disc's rotation tells the speed"
        )
        lines.append('# source = "rotation"\n# radius = "? mm"')
    return "\n".join(lines) + "\n"
