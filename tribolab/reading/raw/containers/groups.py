"""Collection of the columns and settings of a container file by group, one table each."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from tribolab.reading.raw.model import Place, RawColumn, RawFile, RawTable, Setting

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
        """Return a file with a table for each group; settings of other groups belong to the file.

        Parameters
        ----------
        path, container
            Path and format of the file.
        sort
            Whether to sort the tables by name (2 before 10), because the file has no order.
        """
        order = _in_natural_order(list(self._columns)) if sort else list(self._columns)
        # settings next to a single column belong to the file
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


_MAX_SETTING = 200  # most characters of a setting
_PER = re.compile(  # fric_N_per_V, v_set_um_per_s
    r"(?P<key>\w+?)_+(?P<unit>[^\W\d_]{1,6})_per_(?P<other>[^\W\d_]{1,6}\d?)"
)


def plain(value: object) -> object:
    """Return a library's value as a Python number, text or list."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, np.ndarray | np.generic):
        value = value.item() if np.size(value) == 1 else value.tolist()
        return plain(value) if isinstance(value, bytes) else value
    return value


def settings_of(key: str, value: object, path: str = "") -> list[Setting]:
    r"""Return a list with an attribute as setting; empty if its value is nested or blank.

    Parameters
    ----------
    key, value
        Name and value of the attribute.
    path
        Path of its group or dataset.

    Examples
    --------
    >>> [s.line for s in settings_of("gain_N_per_V", 12.5)]
    ['gain [N/V]: 12.5']
    >>> [s.line for s in settings_of("note", "first\nsecond")]
    ['note: first second']
    """
    value = plain(value)
    if isinstance(value, list | tuple):
        plain_ones = all(isinstance(each, str | int | float) for each in value)
        value = ", ".join(map(str, value)) if plain_ones else None
    if value is None or isinstance(value, dict) or not str(value).strip():
        return []
    name = _with_unit(key)
    text = " ".join(str(value).split())[: max(_MAX_SETTING - len(name), 0)]
    return [Setting(name, text, Place(path))]


def _with_unit(key: str) -> str:
    """Return a key with its unit ratio in brackets: gain_N_per_V becomes "gain [N/V]"."""
    key = " ".join(key.split())
    per = _PER.fullmatch(key)
    return f"{per['key']} [{per['unit']}/{per['other']}]" if per else key
