"""Messages that name Python functions and arguments, in words of the command line."""

from __future__ import annotations

import re

_UNITS = r"say them with x_unit= and height_unit=, e\.g\. .*?, or name a dialect with instrument="
# The library tells of its own functions; who types commands has these instead.
_PYTHON_TO_COMMAND = (
    (_UNITS, "name the dialect that says them with --instrument"),
    (r"\binstrument=", "--instrument"),
    (r"\bclock_shift=", "clock_shift in the [[run]] of a campaign file"),
    (
        r": use read_scans(\(\))?",
        "; 'tribolab check' takes it, a campaign under scans of a [[surface]]",
    ),
    (r"\buse read_scans(\(\))?", "try 'tribolab check'"),
    (r" for a profile or map of heights \(read_scans\(\)\)", " for a profile or map of heights"),
    (r"; a profile or map of heights is read by read_scans\(\)", ""),
    (r": use read\b(?!_)(\(\))?", "; a campaign takes it as a [[run]]"),
    (r": use read_results\(\)", "; 'tribolab check' takes it"),
    (r"read them with read_results\(\)", "look at them with 'tribolab check'"),
    (
        r" \(contact_width=\)",
        " (a campaign knows it from [contact])",
    ),
)
_HEIGHTS = "; a profile or map of heights belongs under scans of a [[surface]]"
# A campaign has no options for its files: what they are stands in its tables.
_PYTHON_TO_CAMPAIGN = (
    (_UNITS, 'name the dialect that says them with instrument = "..." in its {table}'),
    (r"\binstrument=", 'instrument = "..." in its {table}'),
    (r" for a run, or one of [^;]*? \(read_scans\(\)\)([^;]*)", rf"\1{_HEIGHTS}"),
    (r"; a profile or map of heights is read by read_scans\(\)", _HEIGHTS),
    (r": use read_scans(\(\))?", "; it belongs under scans of a [[surface]]"),
    (r": use read\b(?!_)(\(\))?", "; it belongs in a [[run]]"),
)


def as_typed(message: str) -> str:
    """Put a message that names Python functions and arguments into words of the command line.

    Examples
    --------
    >>> as_typed("a.csv: two instruments fit; say which with instrument=")
    'a.csv: two instruments fit; say which with --instrument'
    >>> as_typed("the logs do not overlap; give clock_shift=")
    'the logs do not overlap; give clock_shift in the [[run]] of a campaign file'
    """
    for pattern, words in _PYTHON_TO_COMMAND:
        message = re.sub(pattern, words, message)
    return message


def as_in_campaign(message: str, table: str) -> str:
    """Put a message that names Python functions and arguments into words of the campaign file.

    Parameters
    ----------
    message
        What the library says of a file.
    table
        The table that names the file: ``"[[run]]"`` or ``"[[surface]]"``.

    Examples
    --------
    >>> as_in_campaign("a.csv: two instruments fit; say which with instrument=", "[[run]]")
    'a.csv: two instruments fit; say which with instrument = "..." in its [[run]]'
    """
    for pattern, words in _PYTHON_TO_CAMPAIGN:
        message = re.sub(pattern, words.replace("{table}", table), message)
    return as_typed(message)


def range_of(low: str, high: str) -> str:
    """Return lowest to highest as written, once if they read the same.

    Examples
    --------
    >>> range_of("0.004", "0.004"), range_of("1", "2")
    ('0.004', '1 to 2')
    """
    return low if low == high else f"{low} to {high}"
