"""Start time and sampling that the text before a table states, and the order of its rows."""

from __future__ import annotations

import datetime as dt
import re
from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.time_rule import sampling_interval
from tribolab.reading.si_tables.model import Content, Piece
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.units.conversion import positive


def last_match(pattern: str, text: str) -> str | None:
    """Return group 1 of the last match: the text next to a step precedes that at the top."""
    return guarded(pattern).last(text)


def started(text: str, path: Path, dialect: Dialect) -> dt.datetime | None:
    """Return the start time of a table, if the text before the table states one."""
    time = dialect.time
    if time.start_pattern is None or time.start_format is None:
        return None
    stamp = last_match(time.start_pattern, text)
    if stamp is None:
        return None
    try:
        return dt.datetime.strptime(stamp, time.start_format)
    except ValueError as error:
        raise ReadError(
            f"{path}: '{shown(stamp)}' is no date and time of the form "
            f"'{shown(time.start_format)}' (instrument '{dialect.name}', time.start_format)"
        ) from error


_THOUSANDS = re.compile(r"[1-9]\d{0,2}(?:[ \u00a0\u202f',]\d{3})+")  # "1 000"
_COMMA = re.compile(r"\d+,\d+(?:[eE][-+]?\d+)?")


def stated_interval(content: Content, dialect: Dialect, piece: Piece) -> float:
    """Return the sampling interval [s] from the dialect or the file; 1 s if none is stated.

    Parameters
    ----------
    content
        The file, whose preamble may state the rate or interval.
    dialect
        The dialect, which states the value or the pattern that finds it.
    piece
        One of its tables: the text before it takes precedence over the preamble.

    Raises
    ------
    ReadError
        If the value is missing from the file, or is neither a rate nor an interval.
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
        If the speed is missing, or its unit is not one of speed.
    """
    return positive(_stated(content, dialect, content.pieces[0]), "m/s", _where(content, dialect))


def _where(content: Content, dialect: Dialect) -> str:
    return "time.rate" if dialect.time.rate else str(content.path)


def _stated(content: Content, dialect: Dialect, piece: Piece) -> str:
    """Return the stated rate, interval or speed with its unit, from dialect or file; else ""."""
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


_MIN_ROWS = 8  # rows needed to recognise the order


def is_newest_first(time: np.ndarray) -> bool:
    """Whether time decreases from each row to the next.

    >>> is_newest_first(np.arange(9.0)[::-1]), is_newest_first(np.arange(9.0))
    (True, False)
    """
    if time.size < _MIN_ROWS or not time[0] > time[-1]:
        return False
    return bool((time[1:] < time[:-1]).all())


def oldest_first(content: Content) -> Content:
    """Return the content with its only table in order of time, with a note if it was reversed."""
    if len(content.pieces) != 1 or not is_newest_first(content.pieces[0].columns["time"]):
        return content
    [piece] = content.pieces
    turned = {name: np.ascontiguousarray(part[::-1]) for name, part in piece.columns.items()}
    notes = {**content.notes, "rows_turned_round": "the newest row came first"}
    return content._replace(pieces=[piece._replace(columns=turned)], notes=notes)
