"""Single values outside the table: in the preamble, before a step, or in the file name."""

from __future__ import annotations

import re

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.core.untyped import Json
from tribolab.reading.dialect.column_rule import Value
from tribolab.reading.dialect.formula import names_in, parse_formula
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.si_tables.model import Content
from tribolab.reading.si_tables.steps import last_match
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.units.conversion import conversion, to_si

# a decimal comma (21,5) above a table with decimal points; 1,200 is ambiguous and does not match
_OWN_COMMA = re.compile(r"[-+]?(?:\d+,\d{1,2}|\d+,\d{4,}|0,\d+)(?:[eE][-+]?\d+)?")

_OF_NAME = re.compile(r"(?<=\d)[,pP_](?=\d)")


def single_values(content: Content, dialect: Dialect) -> dict[str, str | float]:
    """Return values from the preamble and the file name as attributes named with their unit.

    Raises
    ------
    ReadError
        If a value with a unit is not a number.
    """
    attrs: dict[str, str | float] = {}
    for value in dialect.value:
        if value.source == "step" or value.pattern is None:
            continue
        text = content.path.name if value.source == "file name" else content.pieces[0].before
        text_found = _first_match(value.pattern, text)
        if not text_found and value.source == "preamble":
            text_found = _first_match(value.pattern, content.foot)
        if text_found:
            _check_later_tables(text_found, value, content, dialect)
            attrs[value.attribute] = converted(text_found, value, content, dialect)
    return attrs


def add_assumed(attrs: Json, dialect: Dialect) -> list[Value]:
    """Add default values from the dialect for what the file does not state; return them."""
    lost = [v for v in dialect.value if v.default is not None and v.attribute not in attrs]
    for value in lost:
        attrs[value.attribute] = to_si(str(value.default), value.si_unit, value.name)
    return lost


def tell_assumed(attrs: Json, assumed: list[Value], dialect: Dialect) -> None:
    """Store in the attribute ``assumed`` the default values on which results depend."""
    used = set(dialect.speed.values_named.values())
    for formula in attrs.get("derived", {}).values():
        used |= names_in(parse_formula(formula))
    if texts := [f"{value.name} {value.default}" for value in assumed if value.name in used]:
        attrs["assumed"] = "; ".join(texts)


def _check_later_tables(text: str, value: Value, content: Content, dialect: Dialect) -> None:
    """Raise if the text before a later table states another value that formulas use."""
    used = value.name in dialect.values_used
    if value.source != "preamble" or value.pattern is None or not used:
        return
    for piece in content.pieces[1:]:
        later = last_match(value.pattern, piece.before)
        if later is not None and later != text:
            raise ReadError(
                f"{content.path}: {value.name} is {shown(text)} before the first table and "
                f"{shown(later)} before a later one; say source = 'step' in its [[value]] (dialect "
                f"'{dialect.name}'), so that each has its own"
            )


def step_values(
    contents: list[Content], dialect: Dialect
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Return the values stated for each step: numbers per row as variables, texts as attributes.

    Numbers whose name is not a quantity are used only in formulas.
    """
    variables: dict[str, np.ndarray] = {}
    attrs: dict[str, str] = {}
    places = [(content, piece) for content in contents for piece in content.pieces]
    for value in dialect.value:
        if value.source != "step" or value.pattern is None:
            continue
        texts = [last_match(value.pattern, piece.before) or "" for _, piece in places]
        if value.unit is None:
            attrs[f"{value.name}s"] = "; ".join(
                f"{piece.step}: {text}" for text, (_, piece) in zip(texts, places, strict=True)
            )
        else:
            numbers = [
                converted(text, value, content, dialect) if text else np.nan
                for text, (content, _) in zip(texts, places, strict=True)
            ]
            lengths = [len(piece.columns["time"]) for _, piece in places]
            variables[value.name] = np.repeat(np.array(numbers, dtype=float), lengths)
    return variables, attrs


def _number(text: str, decimal: str) -> float:
    """Return the number in a text with the decimal mark of the table, or with a decimal comma."""
    if decimal == "." and _OWN_COMMA.fullmatch(text):
        decimal = ","
    return float(text.replace(decimal, "."))


def _first_match(pattern: str, text: str) -> str | None:
    return guarded(pattern).first(text)


def converted(text: str, value: Value, content: Content, dialect: Dialect) -> str | float:
    """Return the value in a text as a number in SI units, or as text if the value has no unit.

    Parameters
    ----------
    text
        Text in the file.
    value
        The dialect's rule.
    content, dialect
        The file and its instrument, for the decimal mark and for messages.

    Raises
    ------
    ReadError
        If a value with a unit is not a number.
    """
    if value.unit is None:
        return text
    spelt = text.rstrip(".,")
    try:
        if value.source == "file name":  # "r12p5mm", "R12_5": file names avoid decimal points
            number = float(_OF_NAME.sub(".", spelt))
        else:
            number = _number(spelt, dialect.text.decimal)
    except ValueError as error:
        raise ReadError(
            f"{content.path}: '{shown(text)}' ({value.name}) is not a number; see the value's "
            f"pattern in the dialect '{dialect.name}'"
        ) from error
    scale, offset = conversion(value.unit, value.si_unit, value.bare)
    return float(f"{value.sign * value.scale * number * scale + offset:.15g}")
