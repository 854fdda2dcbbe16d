"""Several tables of the same columns in one file: the steps of a run, and where zeros are read."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import is_unit
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable

_SHARED = 0.8  # of the columns of the largest table, those that another step has, too
_ALIKE = 2  # columns, at least
_NUMBER = re.compile(r"\d+")
# what is recorded without contact or load, by its name
_ZERO = re.compile(
    r"zero(?!\s?(?:speed|velocity))|offset|\btar[ae]\b|tariert|_tare|tare_|blank|unload|no[\W_]?(?:load|contact)"
    r"|lifted|in[\W_]?air|idle|null(?:ab|punkt|kontrolle|mess|lage|wert|ung)|^null|abgehoben|unbelastet|ohne\W?last"
    r"|leerlauf|leermessung|[àa][\W_]vide|z[ée]ro|cero\b|sin[\W_]carga|en[\W_]vac[ií]o|azzer|a[\W_]vuoto|scaric"
    r"|zeragem|sem[\W_]carga|bez[\W_]obci|tarowani|zerow|nulov|bez[\W_]z[aá]t|nulmeting|onbelast|nollst|nollpunkt"
    r"|obelast|ноль|нуль|нулев|без[\W_]нагруз|холост|零点|空载|无负载|ゼロ|無負荷|無荷重|영점",
    re.IGNORECASE,
)
_AFTER = re.compile(
    r"after(?!\W?(?:lift|tare))|\bend\b|ende?$|_end|post|nach(?!\w)|danach|schluss|final|\bfin\b|apr[eè]s|despu|dopo|depois"
    r"|\bpo\b|после|конец|結束|结束|終|后",
    re.IGNORECASE,
)
# the same signals once more, worked on: no other step
_WORKED_ON = re.compile(
    r"raw|filter|smooth|process|average|mean|resampl|correct|\broh|roh(?:daten|werte)|gefiltert|geglättet|brut|liss|filtr"
    r"|crud|grezz|processad|surow|сыр|фильтр|原始|滤波|生データ",
    re.IGNORECASE,
)


class HeldSteps(NamedTuple):
    """Tables that are steps, with the same columns; the pattern of their names; unloaded tables."""

    steps: tuple[RawTable, ...]
    pattern: str
    zeros: tuple[RawTable, ...]

    @property
    def zero(self) -> str:
        """What a dialect says of where a zero is read; "" if nowhere."""
        before = [table.name for table in self.zeros if not self._is_after(table)]
        after = [table.name for table in self.zeros if self._is_after(table)]
        if before and after:
            return f"table {before[-1]} to table {after[0]}"
        return "".join(f"table {name}" for name in [*before[-1:], *after[:1]][:1])

    def _is_after(self, table: RawTable) -> bool:
        return _AFTER.search(table.name) is not None


def find_steps(file: RawFile) -> HeldSteps | None:
    """Find tables that are steps of one run; None if no two tables have the same columns.

    One table beside which another of the same columns is named as what was recorded without
    contact is a run of one step.

    Parameters
    ----------
    file
        Its columns are labelled without their units.
    """
    tables = [_of_signals(table) for table in file.tables]
    tables = [table for table in tables if len(table.columns) >= _ALIKE and table.rows > 1]
    zeros = [table for table in tables if _ZERO.search(_own(table.name))]
    others = [table for table in tables if table not in zeros]
    if not others or len(tables) < 2:
        return None
    largest = max(others, key=lambda table: table.rows * len(table.columns))
    names = list(_by_label(largest))
    needed = max(_ALIKE, _SHARED * len(names))
    steps = [t for t in others if len(_by_label(t).keys() & set(names)) >= needed]
    zeros = [t for t in zeros if _by_label(t).keys() & set(names)]
    if len(steps) + len(zeros) < 2 or _are_copies(steps):
        return None
    common = [n for n in names if all(n in _by_label(table) for table in steps)]
    left = [table.name for table in file.tables if table.name not in {t.name for t in steps}]
    pattern = _pattern([table.name for table in steps], left)
    return HeldSteps(tuple(_with(t, common) for t in steps), pattern, tuple(zeros))


def unit_beside(text: str, name: str, *, counted: bool = False) -> str | None:
    r"""Return the unit that a line of its own says of a column: "fric_unit: V".

    Parameters
    ----------
    text
        What the file says beside its tables.
    name
        What the column is called.
    counted
        Whether it holds whole numbers: then what one is worth is its unit, too.

    Examples
    --------
    >>> unit_beside("rig: A\nfric_unit: V", "fric"), unit_beside("load_units: kN", "fric")
    ('V', None)
    >>> unit_beside("F scale: 0.002 N", "F", counted=True), unit_beside("F scale: 0.002 N", "F")
    ('0.002 N', None)
    """
    if name.casefold() not in text.casefold():  # patterns are slow to make
        return None
    start = rf"^{re.escape(name)}[_. ]"
    words = rf"{start}?(?:units?|einheit|unite)\s*[:=]\s*[\[(]?([^\s\])]+)"
    match = re.search(words, text, re.MULTILINE | re.IGNORECASE)
    if match and is_unit(match[1]):
        return match[1]
    worth = rf"{start}(?:scal\w*|factor|gain|lsb|resolution|slope|per_?count)\s*[:=]\s*"
    match = re.search(
        rf"{worth}(\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s+(\S+)", text, re.MULTILINE | re.IGNORECASE
    )
    if match is None or not is_unit(match[2]):
        return None
    if float(match[1]) == 1:
        return match[2]
    return f"{match[1]} {match[2]}" if counted else None


def _own(name: str) -> str:
    """Return a table's own name, without the folders that it lies in."""
    return name.rsplit("/", 1)[-1].rsplit(".", 1)[-1]


def _by_label(table: RawTable) -> dict[str, RawColumn]:
    """Return the columns by their labels; of several with one label the first."""
    found: dict[str, RawColumn] = {}
    for column in table.columns:
        found.setdefault(column.label, column)
    return found


def _of_signals(table: RawTable) -> RawTable:
    """Return a table with those of its columns that hold numbers and are as long as the longest."""
    numbers = (column for column in table.columns if column.values.dtype.kind in "fiuMm")
    once = _by_label(table._replace(columns=tuple(numbers))).values()
    longest = max((column.values.size for column in once), default=0)
    return table._replace(columns=tuple(c for c in once if c.values.size == longest))


def _with(table: RawTable, labels: Sequence[str]) -> RawTable:
    """Return a table with some of its columns, in an order of their own."""
    columns = _by_label(table)
    return table._replace(columns=tuple(columns[label] for label in labels))


def _are_copies(steps: Sequence[RawTable]) -> bool:
    """Whether tables hold the same signals twice, as raw and filtered ones, or at the same time."""
    if sum(_WORKED_ON.search(_own(table.name)) is not None for table in steps) > len(steps) / 3:
        return True
    for one, other in zip(steps, steps[1:], strict=False):
        columns = _by_label(other)
        for name, values in ((column.label, column.values) for column in one.columns):
            if name not in columns:
                continue
            again = columns[name].values
            if values.dtype.kind == "M" and again.dtype.kind == "M":
                if values[0] < again[-1] and again[0] < values[-1]:
                    return True  # beside each other
            elif values.size == again.size and np.array_equal(values, again):
                if np.ptp(values.astype(float)) > 0 and not _rises(values):
                    return True
    return False


def _rises(values: np.ndarray) -> bool:
    return bool((np.diff(values.astype(float)) > 0).mean() > 0.9)


def _pattern(names: Sequence[str], others: Sequence[str]) -> str:
    """Return a pattern of the names of steps that matches no other table."""
    shapes = {_NUMBER.sub("0", name) for name in names}
    options = []
    if len(shapes) == 1:
        options.append("^" + r"\d+".join(escaped(x) for x in _NUMBER.split(names[0])) + "$")
    folders = {name.rpartition("/")[0] for name in names}
    if len(folders) == 1 and (folder := folders.pop()):
        options.append(f"^{escaped(folder)}/[^/]+$")
    start = os.path.commonprefix(list(names)).rstrip("0123456789")
    if len(names) > 1 and start:
        options.append(f"^{escaped(start)}")
    for pattern in options:
        if not any(re.search(pattern, name) for name in others):
            return pattern
    return "^(?:" + "|".join(escaped(name) for name in names) + ")$"
