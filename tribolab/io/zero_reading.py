"""Zeros that are read where the user says: at the beginning, in an interval, in a blank run."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from tribolab.errors import Cure, ReadError, UnitError, shown
from tribolab.pieces import lowered
from tribolab.quantities import quantity
from tribolab.units import to_si
from tribolab.untyped import Json

_SAMPLES = re.compile(r"^\s*first\s+(\d+)\s+samples?\s*$")
_FIRST = re.compile(r"^\s*first\s+(\S.*?)\s*$")
_BETWEEN = re.compile(r"^\s*(\S.*?)\s+to\s+(\S.*?)\s*$")
_BLANK = re.compile(r"^\s*file\s+(\S.*?)\s*$")
_FEWEST = 10  # samples
_BATCHES = 16  # means whose scatter says how well the zero is known


class ZeroRule(NamedTuple):
    """Where a zero is read: samples from the start, from and to [s], or the name of a file."""

    samples: int = 0
    start: float = -np.inf
    stop: float = np.inf
    file: str = ""


def parse_zero(text: str) -> ZeroRule:
    """Parse where a zero is read.

    Parameters
    ----------
    text
        ``"first 200 samples"``, ``"first 2 s"``, ``"1.5 s to 3 s"`` (time from the first sample) or
        ``"file blank.csv"`` (beside the run's own file).

    Raises
    ------
    UnitError
        If it is none of these.

    Examples
    --------
    >>> parse_zero("first 200 samples").samples, parse_zero("1.5 s to 3 s").stop
    (200, 3.0)
    >>> parse_zero("file blank.csv").file
    'blank.csv'
    """
    if match := _SAMPLES.match(text):
        return ZeroRule(samples=int(match[1]))
    if match := _BLANK.match(text):
        return ZeroRule(file=match[1])
    if match := _FIRST.match(text):
        return ZeroRule(stop=to_si(match[1], "s", "zero"))
    if match := _BETWEEN.match(text):
        return ZeroRule(start=to_si(match[1], "s", "zero"), stop=to_si(match[2], "s", "zero"))
    raise UnitError(
        f"zero: '{shown(text)}' does not say where the zero is read; write 'first 200 samples', "
        "'first 2 s', '1.5 s to 3 s' or 'file blank.csv'"
    )


def take_zeros(
    columns: dict[str, np.ndarray],
    time: np.ndarray,
    rules: Mapping[str, str],
    blank: Callable[[str], Mapping[str, np.ndarray]],
    where: str,
) -> Json:
    """Take the zeros of signals off them.

    Parameters
    ----------
    columns
        Signals in SI by quantity (time); those with a rule are replaced.
    time
        From the first sample [s] (time).
    rules
        Where each quantity's zero is read, see `parse_zero`.
    blank
        Gives the columns of a file that stands in a rule.
    where
        The run, for messages.

    Returns
    -------
    dict
        Attributes: ``<quantity>_zero_N``, its standard error where it was read, from the scatter of
        16 batches (``..._zero_sem_N``), and ``zeros_read``, where that was.

    Raises
    ------
    ReadError
        If the signal is not there, or fewer than 10 samples tell its zero.
    """
    attrs: Json = {}
    said = {}
    for name, text in rules.items():
        if name not in columns:
            continue
        values = _samples(name, parse_zero(text), columns, time, blank, where)
        values = values[np.isfinite(values)]
        if values.size < _FEWEST:
            raise ReadError(
                f"zero of {name}: '{shown(text)}' holds {values.size} numbers, and {_FEWEST} are "
                "needed",
                where=where,
                cure=Cure(*["name a longer stretch in `zero`"] * 3),
            )
        batches = np.array([part.mean() for part in np.array_split(values, _BATCHES) if part.size])
        zero = float(values.mean())
        error = float(batches.std(ddof=1) / np.sqrt(batches.size))
        columns[name] = lowered(columns[name], zero)
        unit = quantity(name).unit
        ending = "" if unit == "1" else f"_{unit}"
        attrs |= {f"{name}_zero{ending}": zero, f"{name}_zero_sem{ending}": error}
        said[name] = text
    if said:
        attrs["zeros_read"] = said
    return attrs


def _samples(
    name: str,
    rule: ZeroRule,
    columns: Mapping[str, np.ndarray],
    time: np.ndarray,
    blank: Callable[[str], Mapping[str, np.ndarray]],
    where: str,
) -> np.ndarray:
    """Return the samples that tell a zero."""
    if rule.file:
        of_file = blank(rule.file)
        if name not in of_file:
            raise ReadError(f"{rule.file}: the blank run holds no {name}", where=where)
        return of_file[name]
    if rule.samples:
        return columns[name][: rule.samples]
    first, last = np.searchsorted(time, [rule.start, rule.stop])
    return columns[name][first:last]
