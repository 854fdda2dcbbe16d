"""Dates and times of day in a column of an unknown table."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.io.dialects.dates import ISO, ISO_ZONE, has_day, seconds

# Day before month or after it: which one, the dates may tell; where they do not it is a guess.
_EUROPE, _AMERICA = "%d/%m/%Y %H:%M:%S", "%m/%d/%Y %H:%M:%S"
_FORMS = (
    *(ISO, ISO_ZONE),
    *("%d.%m.%Y %H:%M:%S", "%d.%m.%Y %H:%M:%S.%f", "%d.%m.%Y %H:%M:%S,%f"),
    *("%Y/%m/%d %H:%M:%S", "%Y/%m/%d %H:%M:%S.%f", "%Y/%m/%d %H:%M:%S,%f"),
    *(_EUROPE, f"{_EUROPE}.%f", f"{_EUROPE},%f", _AMERICA, f"{_AMERICA}.%f", f"{_AMERICA},%f"),
    *(f"{day}%I:%M:%S{part} %p" for day in ("", "%m/%d/%Y ") for part in ("", ".%f")),
    *("%H:%M:%S", "%H:%M:%S.%f", "%H:%M:%S,%f"),
    *("%M:%S.%f", "%M:%S,%f"),  # with a fraction only: 01:30 may be hours and minutes
)
_TRIED = 20
# in a text of each of these forms: a table of 200 columns of words would take a minute to try them
_LIKE_A_DATE = re.compile(r"\d:\d|^\s*\d{4}-?\d\d")


def find_form(texts: Sequence[str]) -> tuple[str, str]:
    """Find the form of the dates and times in a column.

    Parameters
    ----------
    texts
        Its cells.

    Returns
    -------
    tuple
        The form, "" if there is none; and one that fits as well, "" if there is none.

    Examples
    --------
    >>> find_form(["24.12.2024 10:00:00,5", "24.12.2024 10:00:01,0"])
    ('%d.%m.%Y %H:%M:%S,%f', '')
    >>> find_form(["03/04/2024 10:00:00"])[1], find_form(["3.5"])
    ('%m/%d/%Y %H:%M:%S', ('', ''))
    """
    filled = [text for text in texts if text]
    first = filled[:_TRIED]
    if not first or not all(map(_LIKE_A_DATE.search, first)):
        return "", ""
    fitting = [form for form in _FORMS if _fits(first, form)]
    fitting = [form for form in fitting if _fits(filled, form)]
    if not fitting:
        return "", ""
    times = seconds(filled, fitting[0])
    others = (form for form in fitting[1:] if not np.allclose(seconds(filled, form), times))
    return fitting[0], next(others, "")


def _fits(texts: Sequence[str], form: str) -> bool:
    try:
        times = seconds(texts, form)
    except ValueError:
        return False
    return bool((np.diff(times) >= 0).all()) or not has_day(form)
