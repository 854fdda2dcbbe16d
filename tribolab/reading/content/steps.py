"""Information on a step from the text before it."""

from __future__ import annotations

import datetime as dt
from pathlib import Path

from tribolab.core.errors import ReadError, shown
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.text.bounded_patterns import guarded


def last_match(pattern: str, text: str) -> str | None:
    """Return group 1 of a pattern's last match: a step's own text takes precedence."""
    return guarded(pattern).last(text)


def started(text: str, path: Path, dialect: Dialect) -> dt.datetime | None:
    """Return the start time of a step, if the text before it states one."""
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
