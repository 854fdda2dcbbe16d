"""Clocks with an epoch of their own, recognised by the size of their numbers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.text.dates import Epoch
from tribolab.units.conversion import conversion

_DAY = 86400.0  # [s]
# [s] since 1970 and since 1904: from the year 2000 to that of 2050
_SECONDS: tuple[tuple[Epoch, float, float], ...] = (
    ("unix", 946_684_800.0, 2_524_608_000.0),
    ("labview", 3_029_529_600.0, 4_607_452_800.0),
)
_EXCEL = (36_526.0, 54_789.0)  # [d] the same years
_MAX_STEP = 5.0  # [s] beyond which a counter of something smaller is as likely
_MAX_RUN = 400.0  # [d]
_SMALLER = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


class Counted(NamedTuple):
    """Since which moment a clock counts, and in which unit."""

    epoch: Epoch
    unit: str


def counted_from(values: np.ndarray, unit: str | None, *, dated: bool = False) -> Counted | None:
    """Return the epoch of a column of time; None if its numbers do not show it.

    Parameters
    ----------
    values
        Its numbers as written (row).
    unit
        Their unit, None if the file says none.
    dated
        Whether the column is called a date: days of a spreadsheet are believed of no other.

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
