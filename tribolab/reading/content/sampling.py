"""Sampling interval [s] of a table without a time column: from a stated rate or interval."""

from __future__ import annotations

import re

from tribolab.core.errors import ReadError, shown
from tribolab.reading.content.model import Content, Piece
from tribolab.reading.content.steps import last_match
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.time_rule import sampling_interval
from tribolab.units.conversion import positive

_THOUSANDS = re.compile(r"[1-9]\d{0,2}(?:[ \u00a0\u202f',]\d{3})+")  # "1 000"
_COMMA = re.compile(r"\d+,\d+(?:[eE][-+]?\d+)?")


def stated_interval(content: Content, dialect: Dialect, piece: Piece) -> float:
    """Return the sampling interval [s]; 1 s if nothing is stated.

    Parameters
    ----------
    content
        The file, whose preamble may state the rate or interval.
    dialect
        The dialect, which states the value or its place.
    piece
        One of its tables: the text before it takes precedence over the preamble.

    Raises
    ------
    ReadError
        If it is missing, or is neither a rate nor an interval.
    """
    stated = _stated(content, dialect, piece)
    return sampling_interval(stated, _where(content, dialect)) if stated else 1.0


def stated_pace(content: Content, dialect: Dialect) -> float:
    """Return the stated speed [m/s] at which a position increases.

    Parameters
    ----------
    content, dialect
        As for `stated_interval`.

    Raises
    ------
    ReadError
        If it is missing, or is not a speed.
    """
    return positive(_stated(content, dialect, content.pieces[0]), "m/s", _where(content, dialect))


def _where(content: Content, dialect: Dialect) -> str:
    return "time.rate" if dialect.time.rate else str(content.path)


def _stated(content: Content, dialect: Dialect, piece: Piece) -> str:
    """Return the rate or interval of the dialect or the file, with its unit; "" without one."""
    rule = dialect.time
    if rule.rate or not rule.rate_pattern:
        return rule.rate or ""
    number = last_match(rule.rate_pattern, piece.before)
    if number is None:
        number = last_match(rule.rate_pattern, content.pieces[0].before)
    if number is None:
        raise ReadError(
            f"{content.path}: no sample rate matches '{shown(rule.rate_pattern)}' "
            f"(instrument '{dialect.name}', time.rate_pattern)"
        )
    if _THOUSANDS.fullmatch(number) and not (dialect.text.decimal == "," and "," in number):
        number = re.sub(r"\D", "", number)
    elif dialect.text.decimal == "," or _COMMA.fullmatch(number):
        number = number.replace(",", ".")
    return f"{number} {rule.rate_unit}"
