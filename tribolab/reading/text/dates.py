"""Dates and times in columns, and epochs from which clocks count."""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Collection, Iterable
from typing import Literal

import numpy as np

ISO, ISO_ZONE = "iso", "iso with zone"
Epoch = Literal["unix", "excel", "labview"]
# LabVIEW and Unix count in UTC, Excel in local time
_EPOCHS: dict[Epoch, dt.datetime] = {
    "unix": dt.datetime(1970, 1, 1, tzinfo=dt.UTC),
    "excel": dt.datetime(1899, 12, 30),
    "labview": dt.datetime(1904, 1, 1, tzinfo=dt.UTC),
}
_DAY_CODES = ("%d", "%j", "%x", "%c")
_ZONE = re.compile(r":\d\d(?:[.,]\d+)?\s*(?:[Zz]|[+-]\d\d(?::?\d\d)?)$")


def seconds(texts: Iterable[object], form: str, missing: Collection[str] = ()) -> np.ndarray:
    """Return dates and times as seconds since 1970, or since midnight if there is no date.

    Parameters
    ----------
    texts
        The cells.
    form
        "iso", "iso with zone", or as for `datetime.datetime.strptime`.
    missing
        Texts for missing values.

    Returns
    -------
    numpy.ndarray
        NaN for empty cells. Times with a zone are in UTC, others in local time.

    Raises
    ------
    ValueError
        With the first text that has another format as its message.

    Examples
    --------
    >>> seconds(["1970-01-02T00:00:00.25+01:00", ""], "iso with zone").tolist()
    [82800.25, nan]
    >>> seconds(["01:00:00,5"], "%H:%M:%S,%f").tolist()
    [3600.5]
    """
    import pandas as pd  # not needed to describe an instrument

    cells = pd.Series(texts, dtype="object").fillna("").astype(str).str.strip()
    cells = cells.mask(cells.isin(missing), "")
    first = next((text for text in cells if text), "")
    if form == ISO and _ZONE.search(first):
        raise ValueError(first)
    iso = form in (ISO, ISO_ZONE)
    moments = pd.to_datetime(cells, format="ISO8601" if iso else form, utc=True, errors="coerce")
    bad = moments.isna() & (cells != "")
    if bad.any():
        raise ValueError(cells[bad].iloc[0])
    start = pd.Timestamp(0, tz="UTC") if has_day(form) else pd.Timestamp("1900-01-01", tz="UTC")
    return ((moments - start) / pd.Timedelta(1, "s")).to_numpy(dtype=float)


def is_form(text: str) -> bool:
    """Whether a text is a format of dates and times.

    >>> is_form("iso"), is_form("%d.%m.%Y %H:%M:%S"), is_form("dd.mm.yyyy")
    (True, True, False)
    """
    return text in (ISO, ISO_ZONE) or "%" in text


def has_day(form: str) -> bool:
    """Whether a format includes the date, not only the time of day.

    >>> has_day("iso"), has_day("%H:%M:%S")
    (True, False)
    """
    return form in (ISO, ISO_ZONE) or any(code in form for code in _DAY_CODES)


def has_zone(form: str) -> bool:
    """Whether a format includes the time zone.

    >>> has_zone("iso with zone"), has_zone("iso")
    (True, False)
    """
    return form == ISO_ZONE or "%z" in form


def date_of(epoch: Epoch, since: float) -> dt.datetime:
    """Return the date and time `since` seconds after an epoch, to the microsecond.

    Raises
    ------
    OverflowError
        If the result is beyond the range of dates.

    Examples
    --------
    >>> date_of("excel", 45000.5 * 86400).isoformat(), date_of("labview", 0).isoformat()
    ('2023-03-15T12:00:00', '1904-01-01T00:00:00+00:00')
    """
    return _EPOCHS[epoch] + dt.timedelta(seconds=since)
