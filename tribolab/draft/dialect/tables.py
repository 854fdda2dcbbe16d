"""Columns, formulas and single values of a drafted dialect as tables of TOML."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import overload

import numpy as np

from tribolab.draft.follows.model import DraftedFormula
from tribolab.draft.model import UNKNOWN_NAME, DraftColumn
from tribolab.draft.stated.settings import Amount
from tribolab.quantities import quantity

FILL_IN = "FILL IN"


def unused_columns(columns: list[DraftColumn], numbers: np.ndarray) -> str:
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
    parts += [column_table(column, numbers[:, column.place - 1]) for column in others]
    if plain:
        told = (
            f"#   {c.place} '{comment(c.label)}': {_range(numbers[:, c.place - 1])}" for c in plain
        )
        parts.append("\n".join(["# Not used, their names are not known: column", *told]) + "\n")
    if empty:
        parts.append(f"# Empty: column {', '.join(empty)}\n")
    return "\n".join(parts)


def column_table(column: DraftColumn, values: np.ndarray) -> str:
    """Return one column; what is not used stands there as a comment, ready to be filled in."""
    lines = ["[[column]]"]
    lines.append(f'quantity = "{column.quantity or "?"}"')
    if column.name is None:
        lines.append(f"position = {column.place}")
    else:
        lines.append(f"name = {quoted(column.name)}")
        if column.occurrence > 1:
            lines.append(f"occurrence = {column.occurrence}")
    if column.group:
        lines.append(f"group = {quoted(column.group)}")
    if column.unit is not None:
        lines.append(f"unit = {quoted(column.unit)}")
    elif column.file_unit is None and not column.used and not _has_no_unit(column):
        lines.append('unit = "?"')
    if column.scale != 1:
        lines.append(f"scale = {column.scale:.12g}")
    if column.offset:
        lines.append(f"offset = {column.offset:.12g}")
    if column.sign < 0:
        lines.append("sign = -1")
    if column.zero:
        lines.append(f"zero = {quoted(column.zero)}")
    if column.optional:
        lines.append("optional = true")
    about = [f"# guessed: {comment(guess)}" for guess in column.guessed]
    if column.used:
        if column.note:
            about.append(f"# {comment(column.note)}")
        return "\n".join([*about, *lines]) + "\n"
    label = f"column {column.place}" + (f" '{comment(column.label)}'" if column.label else "")
    if column.fill_in:
        about.insert(0, f"# {FILL_IN}: {comment(column.fill_in)}, then remove the '#' below")
    else:
        about = [f"# {label}: {_range(values)}; {comment(column.note or 'not used')}"]
    return "\n".join([*about, *(f"# {line}" for line in lines)]) + "\n"


def symbol_table(symbol: str, column: DraftColumn) -> str:
    """Return a column that is there for formulas."""
    lines = column_table(column._replace(quantity=symbol, used=True, note=""), np.empty(0))
    return lines.replace(f'quantity = "{symbol}"', f'symbol = "{symbol}"')


def formula_table(formula: DraftedFormula) -> str:
    """Return a quantity that follows from others."""
    lines = ["[[derived]]", f'quantity = "{formula.quantity}"', f'formula = "{formula.formula}"']
    if formula.zero:
        lines.append(f"zero = {quoted(formula.zero)}")
    lines += [f'way = "{formula.way}"'] if formula.way else []
    return "\n".join([f"# {comment(formula.about)}", *lines]) + "\n"


def value_tables(values: list[Amount], used: Sequence[Amount]) -> str:
    """Return the single values that are used, and proposals for others as comments."""
    kept = []
    for value in used:
        about = f"guessed: {value.guess}" if value.guess else value.text
        kept.append("\n".join([f"# {comment(about)}", *_value(value)]) + "\n")
    patterns = {value.pattern for value in used}
    values = [value for value in values if value.pattern not in patterns]
    if not values:
        return "\n".join(kept)
    parts = ["# Single values that the file states. To keep one, remove the '#' before it.\n"]
    for value in values:
        about = f"# {comment(value.text)}"
        parts.append("\n".join([about, *(f"# {line}" for line in _value(value))]) + "\n")
    return "\n".join([*kept, *parts])


def _value(value: Amount) -> list[str]:
    """Return one value as it stands in a dialect."""
    lines = ["[[value]]", f"name = {quoted(value.name)}"]
    if value.source != "preamble":
        lines.append(f"source = {quoted(value.source)}")
    lines.append(f"pattern = {quoted_pattern(value.pattern)}")
    if value.unit is not None:
        lines.append(f"unit = {quoted(value.unit)}")
    if value.scale != 1:
        lines.append(f"scale = {value.scale:g}")
    if value.to is not None:
        lines.append(f"to = {quoted(value.to)}")
    return lines


def _has_no_unit(column: DraftColumn) -> bool:
    return column.quantity is not None and quantity(column.quantity).unit == "1"


def _range(values: np.ndarray) -> str:
    finite = values[np.isfinite(values)]
    ends = (
        dict.fromkeys(f"{end:.6g}" for end in (finite.min(), finite.max())) if finite.size else {}
    )
    return " to ".join(ends) or "no number"


def comment(text: str) -> str:
    """Text as it may stand in a comment, on one line."""
    return re.sub(r"[\x00-\x1f\x7f\u0085\u2028\u2029]+", " ", text)


def quoted(text: str) -> str:
    """Text between quotation marks."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def quoted_pattern(text: str) -> str:
    """Pattern between quotation marks, in which a backslash is one where that can be."""
    plain = "'" not in text and text.isprintable()
    return f"'{text}'" if plain else quoted(text)


@overload
def any_blanks(pattern: str) -> str: ...


@overload
def any_blanks(pattern: str | None) -> str | None: ...


def any_blanks(pattern: str | None) -> str | None:
    r"""Return a pattern that holds for any number of blanks or tabs where it has some.

    Of a table whose cells blanks part, the reader sees one tab for each row of blanks.

    >>> any_blanks(r"^\s*# sample  rate:\s*(\d+)")
    '^\\s*#[ \\t]+sample[ \\t]+rate:\\s*(\\d+)'
    """
    return None if pattern is None else re.sub(r"(?:(?<!\\) |\\t)+", r"[ \\t]+", pattern)
