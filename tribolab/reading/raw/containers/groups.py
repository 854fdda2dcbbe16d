"""Collection of columns and settings by group, for the tables of a file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from tribolab.reading.raw.model import RawColumn, RawFile, RawTable, Setting

_NUMBERS = re.compile(r"\d+")


class Groups:
    """Columns and settings by group name, in the order of the file."""

    def __init__(self) -> None:
        self._columns: dict[str, list[RawColumn]] = {}
        self._settings: dict[str, list[Setting]] = {}

    def add_column(self, group: str, column: RawColumn) -> None:
        """Add a column to a group."""
        self._columns.setdefault(group, []).append(column)

    def add_settings(self, group: str, settings: Iterable[Setting]) -> None:
        """Add settings to a group."""
        self._settings.setdefault(group, []).extend(settings)

    def as_file(self, path: Path, container: str, *, sort: bool = False) -> RawFile:
        """Return the groups as tables; settings of groups without a table are those of the file.

        Parameters
        ----------
        path, container
            Path and format of the file.
        sort
            Whether to sort the tables by name (2 before 10), because the file has no order.
        """
        order = _in_natural_order(list(self._columns)) if sort else list(self._columns)
        # a single column next to settings is a setting
        apart = {name for name in order if name and len(self._columns[name]) > 1}
        tables = []
        for name in order:
            settings = self._settings.get(name, []) if name else []
            tables.append(RawTable(name, tuple(self._columns[name]), tuple(settings)))
        rest = (s for name, group in self._settings.items() if name not in apart for s in group)
        return RawFile(path, container, tuple(tables), tuple(rest))


def _in_natural_order(names: Sequence[str]) -> list[str]:
    """Sort names in natural order, with 2 before 10.

    >>> _in_natural_order(["step10", "step9", "step1"])
    ['step1', 'step9', 'step10']
    """

    def key(name: str) -> list[tuple[str, int]]:
        numbers = [int(digits) for digits in _NUMBERS.findall(name)[:20]]
        return list(zip(_NUMBERS.split(name), [*numbers, 0], strict=False))

    return sorted(names, key=key)
