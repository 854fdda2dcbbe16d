"""Numbers, words and dates in the cells of an unknown table, and the epochs of clocks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.raw.missing_marks import LARGEST, take_marks
from tribolab.reading.text.cells import split_row
from tribolab.reading.text.dates import ISO, ISO_ZONE, Epoch, has_day, seconds
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.conversion import conversion

_LONGEST_WORD = 30  # characters
_MAX_WORDS = 10  # different words for a missing value


class Cells(NamedTuple):
    """Contents of the cells of a table.

    Attributes
    ----------
    numbers
        Numbers of all rows (rows, columns); NaN for other cells.
    text
        For each column the first of its words if most of its cells are words, else "".
    missing
        For each column the words that it contains in place of numbers.
    """

    numbers: np.ndarray
    text: list[str]
    missing: list[list[str]]


def read_cells(layout: Layout) -> Cells:
    """Return the numbers and words of all rows of a table."""
    width = layout.width
    text, missing = [""] * width, [list[str]() for _ in range(width)]
    if layout.numbers is not None:
        return Cells(_measured(layout.numbers.copy()), text, missing)
    rows = [split_row(line, layout.delimiter) for line in layout.rows()]
    numbers = np.empty((len(rows), width))
    for place in range(width):
        cells = [row[place] if place < len(row) else "" for row in rows]
        numbers[:, place], words = _numbers_and_words(cells, layout.decimal)
        if 2 * len(words) > sum(map(bool, cells)):
            text[place] = words[0][:_LONGEST_WORD]
        else:
            missing[place] = list(dict.fromkeys(words))[:_MAX_WORDS]
    return Cells(_measured(numbers), text, missing)


def _numbers_and_words(cells: Sequence[str], decimal: str) -> tuple[np.ndarray, list[str]]:
    """Return the numbers of a column, NaN for other cells, and its words.

    >>> _numbers_and_words(["1,5", "", "err", "NaN"], ",")
    (array([1.5, nan, nan, nan]), ['err'])
    """
    numbers, words = np.full(len(cells), np.nan), []
    for row, cell in enumerate(cells):
        try:
            numbers[row] = float(cell.replace(decimal, ".") if "_" not in cell else "no number")
        except ValueError:
            if cell:
                words.append(cell)
    return numbers, words


def _measured(numbers: np.ndarray) -> np.ndarray:
    """Replace no-data values by NaN, as the reader does."""
    numbers[np.abs(numbers) > LARGEST] = np.nan
    for values in numbers.T:
        take_marks([values])
    return numbers


# Whether the day precedes the month is a guess, unless the dates decide it.
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
# occurs in all these formats; without this test, 200 columns of words would take a minute
_LIKE_A_DATE = re.compile(r"\d:\d|^\s*\d{4}-?\d\d")


def find_form(texts: Sequence[str]) -> tuple[str, str]:
    """Return the format of dates and times in a column, and a second format that also fits.

    Either is "" if there is none.

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


def take_dates(columns: list[DraftColumn], layout: Layout, cells: Cells) -> list[DraftColumn]:
    """Take a column of dates as the time if no column of numbers is; write its times to `cells`."""
    numbers, text = cells.numbers, cells.text
    timed = [c for c in columns if c.quantity == "time" and c.used and not text[c.place - 1]]
    dates = [] if timed or not any(text) else list(_dates(columns, layout, cells))
    if not dates:
        return columns
    # prefer a column that changes: dates without time of day do not
    column, moments, form, other = next((one for one in dates if np.ptp(one[1]) > 0), dates[0])
    numbers[:, column.place - 1] = moments
    dated = column._replace(
        quantity="time",
        unit=None,
        form=form,
        used=True,
        guessed=(f"dates are written {form}",) if other else (),
        options=(other,) if other else (),
        note="",
        fill_in="",
    )
    others = [c._replace(quantity=None, used=False) if c.quantity == "time" else c for c in columns]
    return [dated if c is column else o for c, o in zip(columns, others, strict=True)]


def _dates(
    columns: list[DraftColumn], layout: Layout, cells: Cells
) -> Iterator[tuple[DraftColumn, np.ndarray, str, str]]:
    """Yield columns of dates with their times [s], their format, and another format that fits."""
    rows = [split_row(line, layout.delimiter) for line in layout.rows()]
    for column in columns:
        index = column.place - 1
        words = [row[index] if index < len(row) else "" for row in rows]
        form, other = find_form(words if cells.text[index] else [])
        if form:
            yield column, seconds(words, form), form, other


_DAY = 86400.0  # [s]
# the years 2000 to 2050 in seconds since 1970 and since 1904
_SECONDS: tuple[tuple[Epoch, float, float], ...] = (
    ("unix", 946_684_800.0, 2_524_608_000.0),
    ("labview", 3_029_529_600.0, 4_607_452_800.0),
)
_EXCEL = (36_526.0, 54_789.0)  # the same years in days
_MAX_STEP = 5.0  # s between rows; with longer steps, a smaller unit is as likely
_MAX_RUN = 400.0  # days of a run
_SMALLER = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


class Counted(NamedTuple):
    """Epoch from which a clock counts, and the unit in which it counts."""

    epoch: Epoch
    unit: str


def counted_from(values: np.ndarray, unit: str | None, *, dated: bool = False) -> Counted | None:
    """Return the epoch and unit of a time column; None if its numbers do not show them.

    Parameters
    ----------
    values
        Its numbers as written (row).
    unit
        Unit of the numbers; None if the file states none.
    dated
        Whether the name means a date: without a unit, only such numbers may be spreadsheet days.

    Examples
    --------
    >>> counted_from(1772600000000 + np.arange(0, 200, 20.0), None)
    Counted(epoch='unix', unit='ms')
    >>> counted_from(3855451200 + np.arange(3.0), "s")
    Counted(epoch='labview', unit='s')
    >>> counted_from(np.arange(3.0), None)
    """
    finite = values[np.isfinite(values)]
    if finite.size < 3:
        return None
    low, high = float(finite.min()), float(finite.max())
    step = float(np.median(np.abs(np.diff(finite))))
    days = dated if unit is None else converts(unit, "s") and conversion(unit, "s")[0] == _DAY
    if days:
        whole = bool((finite == np.round(finite)).all())
        inside = _EXCEL[0] <= low and high <= _EXCEL[1] and high - low < _MAX_RUN
        return Counted("excel", unit or "d") if inside and not whole else None
    units = _SMALLER if unit is None else {unit: conversion(unit, "s")[0]}
    for name, scale in units.items():
        for epoch, first, last in _SECONDS:
            if first <= scale * low and scale * high <= last and scale * step <= _MAX_STEP:
                return Counted(epoch, name)
    return None
