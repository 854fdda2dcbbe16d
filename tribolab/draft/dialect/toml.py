"""A drafted dialect as TOML for people: comments say what was guessed and what is missing."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence

import numpy as np

from tribolab.draft.columns.follows import Follows, Formula, what_follows
from tribolab.draft.columns.values import DraftValue, find_pitch, find_values
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import UNKNOWN_NAME, DraftColumn, Understood
from tribolab.io.dialects.dates import has_day
from tribolab.quantities import quantity

FILL_IN = "FILL IN"


def dialect_toml(name: str, layout: Layout, understood: Understood) -> str:
    """Return the TOML text of a dialect that reads a file as it was understood.

    Parameters
    ----------
    name
        Name of the dialect.
    layout, understood
        What was found out about the file.
    """
    columns = understood.columns
    used = [column for column in columns if column.used]
    parts = [_head(name, layout, understood)]
    names = dict.fromkeys(c.name for c in used if c.name and not c.optional)
    if layout.heading and names and not (layout.held and layout.held.form == "tdms"):
        parts.append("[recognise]\nheader = [" + ", ".join(map(_text, names)) + "]\n")
    elif not layout.heading:
        parts.append(f"[recognise]\ncolumns = {layout.width}\n")
    parts += [_text_table(layout, understood), _header_table(layout, used)]
    follows = what_follows(layout, understood)
    parts += [_time_table(understood), _speed_table(understood.kind, columns, follows)]
    numbers = understood.numbers
    parts += [_column(column, numbers[:, column.place - 1]) for column in used]
    parts += [_symbol(symbol, column) for symbol, column in follows.symbols]
    wanted = [column for column in columns if column.fill_in]
    parts += [_column(column, numbers[:, column.place - 1]) for column in wanted]
    taken = {column.place for _, column in follows.symbols}
    rest = [c for c in columns if not c.used and not c.fill_in and c.place not in taken]
    parts.append(_unused(rest, numbers))
    values, taken_over = find_values(layout), follows.values
    if understood.pitch_pattern and (pitch := find_pitch(layout)) is not None:
        values = [pitch, *(value for value in values if value.text != pitch.text)]
        taken_over = (*taken_over, pitch)
    parts.append(_values(values, taken_over))
    parts += [_formula(formula) for formula in follows.formulas]
    text = "\n".join(part for part in parts if part)
    return text.encode("utf-8", "replace").decode()  # the file's name may hold any bytes


def _head(name: str, layout: Layout, understood: Understood) -> str:
    file = _comment(layout.file.path.name)
    lines = [
        f"# Drafted from '{file}'. Look at what is marked 'guessed'.",
        f"name = {_text(name)}",
        f"title = {_text('files like ' + file)}",
    ]
    if layout.held is not None:
        lines.append(f'format = "{layout.held.form}"')
    lines += [
        f"# guessed: {_comment(guess)}"
        for guess in (*layout.notes, *layout.guesses, *understood.guesses)
    ]
    if understood.pitch:
        lines.append(f"pitch = {_text(understood.pitch)}")
    if understood.pitch_pattern:
        lines.append('pitch_value = "pitch"    # its heights have no positions')
    if layout.others:
        lines.append(f"# {layout.others} more tables stand in the file; they are not read")
    return "\n".join(lines) + "\n"


def _text_table(layout: Layout, understood: Understood) -> str:
    if layout.held is not None:
        return ""
    lines = ["[text]"]
    if layout.delimiter != ",":
        lines.append(f"delimiter = {_text(layout.delimiter)}")
    if layout.encoding != "utf-8":
        lines.insert(1, f"encoding = {_text(layout.encoding)}")
    if layout.decimal != "." or layout.quoted:
        lines.append('decimal = ","')
    if layout.thousands:
        lines.append(f"thousands = {_text(layout.thousands)}")
    if understood.missing:
        lines.append("missing = [" + ", ".join(map(_text, understood.missing)) + "]")
    if layout.end:
        lines.append(f"end = {_pattern(layout.end)}")
    if layout.skip_lines:
        lines.append(f"skip_lines = {_pattern(layout.skip_lines)}    # guessed: the table goes on")
    return "\n".join(lines) + "\n" if len(lines) > 1 else ""


def _header_table(layout: Layout, used: list[DraftColumn]) -> str:
    held = layout.held
    if held is not None:
        below = 'units = "row"\n' if held.units_below else ""
        sheet = f"[header]\nline = {held.line}\n{below}sheet = {_text(held.sheet)}\n"
        return sheet if held.sheet else ""
    lines = ["[header]"]
    if layout.heading:
        if layout.header_pattern:
            lines.append(f"pattern = {_pattern(layout.header_pattern)}")
        else:
            lines.append(f"line = {layout.header_line}")
        units = "row" if layout.heading.units is not None else "brackets"
        units = units if layout.heading.aligned else "dialect"
        if units != "brackets":
            lines.append(f'units = "{units}"')
        if units == "row" and layout.units_line > 1:
            lines.append(f"units_line = {layout.units_line}")
        if layout.repeats:
            lines.append("repeats = true")
        if layout.step:
            lines.append(f"step = {_pattern(layout.step)}")
    if layout.skip:
        lines.append(f"skip = {layout.skip}")
    return "\n".join(lines) + "\n" if len(lines) > 1 else ""


def _time_table(understood: Understood) -> str:
    lines = ["[time]"]
    for column in understood.columns:
        if column.used and column.form:
            lines.append(f"format = {_text(column.form)}")
            if not has_day(column.form):
                hours = "%H" in column.form or "%I" in column.form
                lines.append(f'wrap = "{"24 h" if hours else "60 min"}"')
    timed = any(c.used and c.quantity == "time" for c in understood.columns)
    if understood.period:
        lines.append('source = "period"    # the column holds what has passed since the row before')
    if not timed and understood.rate_pattern:
        lines += ['source = "rate"', f"rate_pattern = {_pattern(understood.rate_pattern)}"]
        if understood.rate_unit != "Hz":
            lines.append(f"rate_unit = {_text(understood.rate_unit)}")
    elif not timed:
        lines.append('source = "none"')
        if understood.kind == "run":
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


def _speed_table(kind: str, columns: Sequence[DraftColumn], follows: Follows) -> str:
    names = {column.quantity for column in columns if column.used}
    if follows.speed is not None:
        lines = ["[speed]", f'source = "{follows.speed.source}"']
        lines += [f"{key} = {_text(value)}" for key, value in follows.speed.settings]
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


def _unused(columns: list[DraftColumn], numbers: np.ndarray) -> str:
    """Return columns that nothing is known of; the empty ones among them in one line."""
    filled = np.isfinite(numbers).any(axis=0)
    empty = [
        str(c.place) for c in columns if not c.label and not filled[c.place - 1] and not c.note
    ]
    others = [column for column in columns if str(column.place) not in empty]
    plain = [c for c in others if c.label and not c.quantity and c.note == UNKNOWN_NAME]
    others = [column for column in others if column not in plain]
    parts = []
    if others:
        parts.append(
            "# Not used. To use a column remove the '#' before it and put in what is '?'.\n"
        )
    parts += [_column(column, numbers[:, column.place - 1]) for column in others]
    if plain:
        told = (
            f"#   {c.place} '{_comment(c.label)}': {_range(numbers[:, c.place - 1])}" for c in plain
        )
        parts.append("\n".join(["# Not used, their names are not known: column", *told]) + "\n")
    if empty:
        parts.append(f"# Empty: column {', '.join(empty)}\n")
    return "\n".join(parts)


def _column(column: DraftColumn, values: np.ndarray) -> str:
    """Return one column; what is not used stands there as a comment, ready to be filled in."""
    lines = ["[[column]]"]
    lines.append(f'quantity = "{column.quantity or "?"}"')
    if column.name is None:
        lines.append(f"position = {column.place}")
    else:
        lines.append(f"name = {_text(column.name)}")
        if column.occurrence > 1:
            lines.append(f"occurrence = {column.occurrence}")
    if column.group:
        lines.append(f"group = {_text(column.group)}")
    if column.unit is not None:
        lines.append(f"unit = {_text(column.unit)}")
    elif column.file_unit is None and not column.used and not _has_no_unit(column):
        lines.append('unit = "?"')
    if column.sign < 0:
        lines.append("sign = -1")
    if column.optional:
        lines.append("optional = true")
    about = [f"# guessed: {_comment(guess)}" for guess in column.guessed]
    if column.used:
        if column.note:
            about.append(f"# {_comment(column.note)}")
        return "\n".join([*about, *lines]) + "\n"
    label = f"column {column.place}" + (f" '{_comment(column.label)}'" if column.label else "")
    if column.fill_in:
        about.insert(0, f"# {FILL_IN}: {_comment(column.fill_in)}, then remove the '#' below")
    else:
        about = [f"# {label}: {_range(values)}; {_comment(column.note or 'not used')}"]
    return "\n".join([*about, *(f"# {line}" for line in lines)]) + "\n"


def _symbol(symbol: str, column: DraftColumn) -> str:
    """Return a column that is there for formulas."""
    lines = _column(column._replace(quantity=symbol, used=True, note=""), np.empty(0))
    return lines.replace(f'quantity = "{symbol}"', f'symbol = "{symbol}"')


def _formula(formula: Formula) -> str:
    lines = ["[[derived]]", f'quantity = "{formula.quantity}"', f'formula = "{formula.formula}"']
    return "\n".join([f"# {_comment(formula.about)}", *lines]) + "\n"


def _values(values: list[DraftValue], used: Sequence[DraftValue]) -> str:
    """Return the single values that are used, and proposals for others as comments."""
    kept = ["\n".join([f"# {_comment(v.text)}", *_value(v)]) + "\n" for v in used]
    patterns = {value.pattern for value in used}
    values = [value for value in values if value.pattern not in patterns]
    if not values:
        return "\n".join(kept)
    parts = ["# Single values that the file states. To keep one, remove the '#' before it.\n"]
    for value in values:
        about = f"# {_comment(value.text)}"
        parts.append("\n".join([about, *(f"# {line}" for line in _value(value))]) + "\n")
    return "\n".join([*kept, *parts])


def _value(value: DraftValue) -> list[str]:
    """Return one value as it stands in a dialect."""
    lines = ["[[value]]", f"name = {_text(value.name)}"]
    if value.source != "preamble":
        lines.append(f"source = {_text(value.source)}")
    lines.append(f"pattern = {_pattern(value.pattern)}")
    if value.unit is not None:
        lines.append(f"unit = {_text(value.unit)}")
    if value.scale != 1:
        lines.append(f"scale = {value.scale:g}")
    if value.to is not None:
        lines.append(f"to = {_text(value.to)}")
    return lines


def _has_no_unit(column: DraftColumn) -> bool:
    return column.quantity is not None and quantity(column.quantity).unit == "1"


def _range(values: np.ndarray) -> str:
    finite = values[np.isfinite(values)]
    ends = (
        dict.fromkeys(f"{end:.6g}" for end in (finite.min(), finite.max())) if finite.size else {}
    )
    return " to ".join(ends) or "no number"


def _comment(text: str) -> str:
    """Text as it may stand in a comment, on one line."""
    return re.sub(r"[\x00-\x1f\x7f\u0085\u2028\u2029]+", " ", text)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _pattern(text: str) -> str:
    plain = "'" not in text and text.isprintable()
    return f"'{text}'" if plain else _text(text)
