"""A column of a file that names its columns, and which others in it are called the same."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.lexicon.lexicon import known_words
from tribolab.reading.unknown.layout.header import names_any

ROWS = 20_000  # rows looked at
_TOLD = 4  # other tables that are named


class HeldColumn(NamedTuple):
    """A column: its name as the reader finds it, that within its table, its unit, its numbers.

    `said` is whether the reader finds the unit by itself; `shown` is what it is called for whoever
    looks for its meaning, where that is not its name.
    """

    name: str
    label: str
    unit: str | None
    values: np.ndarray
    table: str = ""
    said: bool = True
    shown: str = ""


def better_name(name: str, meaning: str) -> str:
    """Return the description of a column if its name alone has no meaning; else "".

    >>> better_name("F_nrm", "normal force, by the leaf spring"), better_name("Fx", "lateral force")
    ('normal force', '')
    """
    words = re.split(r"[,;:(\[]|\s[-–—]\s", meaning)[0].strip()
    quantities = [word.quantity for word in known_words("run")]
    if not words or names_any(name, *quantities) or not names_any(words, *quantities):
        return ""
    return words


def one_of_each(columns: Sequence[HeldColumn]) -> list[HeldColumn]:
    """Omit tables in groups next to another one with columns of the same names."""
    kept: dict[str, set[str]] = {}
    left: set[str] = set()
    tables: dict[str, list[str]] = {}
    for column in columns:
        tables.setdefault(column.table, []).append(column.label)
    for table, names in tables.items():
        if len(names) > 1 and any(len(set(names) & known) > 1 for known in kept.values()):
            left.add(table)
        else:
            kept[table] = set(names)
    return [column for column in columns if column.table not in left]


def others_alike(chosen: Sequence[HeldColumn], every: Sequence[HeldColumn]) -> str:
    """Name other tables that have columns of the same names as the chosen; "" if none."""
    names = {column.label for column in chosen}
    meant = set(map(id, chosen))
    alike: dict[str, int] = {}
    for column in every:
        if id(column) not in meant and column.label in names:
            alike[column.table] = alike.get(column.table, 0) + 1
    tables = [f"'{shown(table, 30)}'" for table, count in alike.items() if table and count > 1]
    return ", ".join(tables[:_TOLD])
