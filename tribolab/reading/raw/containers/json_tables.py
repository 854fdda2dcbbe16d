"""JSON files with columns of numbers: their tables and settings."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.core.untyped import Json
from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable, Setting
from tribolab.reading.unit_texts import is_unit_of_key, without_unit

_MIN_NUMBERS = 3  # smallest length of a column
_ROWS = 5  # fewest records or rows of a table
_DEEPEST = 12  # deepest nesting searched
_MAX_PARTS = 3_000_000  # most lists and objects in a document; each takes a hundred bytes
_MAX_SETTINGS = 60
_MAX_SETTING = 200  # most characters of a setting
_SET = re.compile(r"set[_ -]?(?:point)?s?|target|soll\w*|commanded|programmed", re.IGNORECASE)


class _Table(NamedTuple):
    """Columns by name, their units, and the settings next to them."""

    columns: dict[str, list[float]]
    units: dict[str, str]
    settings: list[Setting]


def has_tables(text: str) -> bool:
    """Whether a text is JSON with at least two columns of numbers."""
    return bool(_tables(text)[0])


def read_json(path: Path) -> RawFile:
    r"""Read the settings of a JSON file, and the tables of the kind that has the most numbers.

    Raises
    ------
    ReadError
        If the file has no columns of numbers.

    Notes
    -----
    Columns are lists of equal length in one object, lists of records, rows below their names, or
    objects with a name and values. Of several kinds of tables, that with most numbers is used.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.json"
    >>> _ = path.write_text('{"r_mm": 5, "units": {"t": "s"}, "t": [0, 1, 2], "F": [3, 4, null]}')
    >>> table = read_json(path).tables[0]
    >>> table.settings[0].line, [(column.label, column.unit) for column in table.columns]
    ('r: 5 mm', [('t', 's'), ('F', None)])
    """
    tables, settings, units = _tables(path.read_text("utf-8-sig"))
    if not tables:
        raise ReadError("no columns of numbers are in the file", where=path)
    sizes: Counter[tuple[str, ...]] = Counter()
    for table in tables:
        sizes[tuple(sorted(table.columns))] += sum(map(len, table.columns.values()))
    kind = sizes.most_common(1)[0][0]
    chosen = [table for table in tables if tuple(sorted(table.columns)) == kind]
    found = []
    for number, table in enumerate(chosen, 1):
        own = units | table.units
        columns = tuple(
            RawColumn(_clean(name), own.get(name) or None, np.array(table.columns[name]))
            for name in chosen[0].columns
        )
        name = f"Step {number}" if len(chosen) > 1 else ""
        found.append(RawTable(name, columns, tuple(_with_units(table.settings, units))))
    return RawFile(path, "json", tuple(found), tuple(settings[:_MAX_SETTINGS]))


def _tables(text: str) -> tuple[list[_Table], list[Setting], dict[str, str]]:
    if text.count("[") + text.count("{") > _MAX_PARTS:
        return [], [], {}
    try:
        document = json.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError):
        return [], [], {}
    tables: list[_Table] = []
    settings = _walk(document, "", tables, 0)
    names = {name for table in tables for name in table.columns}
    units = dict(_units(document, names, "", 0))
    return tables, _with_units(settings, units), units


def _walk(part: Json | list[object], key: str, tables: list[_Table], depth: int) -> list[Setting]:
    """Append the tables in a part of a document to `tables`; return settings outside tables."""
    if depth > _DEEPEST:
        return []
    columns, units = _columns(part)
    if isinstance(part, dict):
        before = len(tables)
        own = _settings_of_object(part, key)
        if columns:
            tables.append(_Table(columns, units, own))
            return []
        for name, inner in part.items():
            if isinstance(inner, dict | list) and _setting(name, inner) is None:
                own += _walk(inner, name, tables, depth + 1)
        if len(tables) == before + 1 and depth:  # settings next to a single table belong to it
            tables[-1] = tables[-1]._replace(settings=[*own, *tables[-1].settings])
            return []
        return own
    if columns:
        tables.append(_Table(columns, units, []))
        return []
    settings: list[Setting] = []
    for inner in part:
        if isinstance(inner, dict | list):
            settings += _walk(inner, key, tables, depth + 1)
    return settings


def _columns(part: object) -> tuple[dict[str, list[float]], dict[str, str]]:
    """Return the columns and units in a part of a document; empty if it is not a table."""
    if isinstance(part, dict):
        named = part.get("columns", part.get("fields", part.get("header")))
        rows = next((part[k] for k in ("data", "rows", "values") if k in part), None)
        if isinstance(named, list) and isinstance(rows, list):
            names = [_named(name) for name in named]
            if columns := _of_rows([name for name, _ in names], rows):
                return columns, {name: unit for name, unit in names if unit}
        lists = {k: _numbers_of(v) for k, v in part.items()}
        return _of_common_length({k: v for k, v in lists.items() if v is not None}), {}
    if not isinstance(part, list) or not part:
        return {}, {}
    if all(isinstance(one, dict) for one in part):
        channels = [(_named(one), _values_of(one)) for one in part]
        if len(part) > 1 and all(name and values for (name, _), values in channels):
            columns = _of_common_length({name: values or [] for (name, _), values in channels})
            return columns, {name: unit for (name, unit), _ in channels if unit}
        return _of_records(part), {}
    if isinstance(part[0], list) and all(isinstance(name, str) for name in part[0]):
        return _of_rows(list(part[0]), part[1:]), {}
    return {}, {}


def _named(one: object) -> tuple[str, str]:
    """Return name and unit of a channel."""
    if isinstance(one, str):
        return one, ""
    if not isinstance(one, dict):
        return "", ""
    texts = {k.lower(): v for k, v in one.items() if isinstance(v, str)}
    name = next((texts[k] for k in keys_of("name") if k in texts), "")
    return name, next((texts[k] for k in keys_of("unit") if k in texts), "")


def _values_of(one: Json) -> list[float] | None:
    lists = [values for value in one.values() if (values := _numbers_of(value)) is not None]
    return lists[0] if len(lists) == 1 else None


def _numbers_of(values: object) -> list[float] | None:
    """Return a list of numbers, also from an object with keys "0", "1" ...; else None."""
    if isinstance(values, dict) and len(values) >= _MIN_NUMBERS and all(map(str.isdigit, values)):
        values = list(values.values())
    if not isinstance(values, list) or len(values) < _MIN_NUMBERS:
        return None
    if any(value is not None and not _is_number(value) for value in values):
        return None
    return [math.nan if value is None else float(value) for value in values]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _of_common_length(lists: dict[str, list[float]]) -> dict[str, list[float]]:
    """Return the lists that share the most common length; none unless at least two do."""
    lengths = Counter(map(len, lists.values()))
    length, often = lengths.most_common(1)[0] if lengths else (0, 0)
    return {k: v for k, v in lists.items() if len(v) == length} if often > 1 else {}


def _of_records(records: list[Json]) -> dict[str, list[float]]:
    names = [k for k, v in records[0].items() if _is_number(v) or v is None]
    if len(records) < _ROWS or len(names) < 2:
        return {}
    columns = {name: [record.get(name) for record in records] for name in names}
    return {k: listed for k, v in columns.items() if (listed := _numbers_of(v)) is not None}


def _of_rows(names: list[str], rows: list[object]) -> dict[str, list[float]]:
    if len(names) < 2 or len(rows) < _ROWS or "" in names:
        return {}
    if not all(isinstance(row, list) and len(row) == len(names) for row in rows):
        return {}
    columns = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
    return {k: listed for k, v in columns.items() if (listed := _numbers_of(v)) is not None}


def _settings_of_object(part: Json, key: str) -> list[Setting]:
    """Return the single values of an object as settings, e.g. "radius: 15 mm"."""
    before = f"{_clean(key)} " if _SET.fullmatch(key) else ""
    found = (settings for name, value in part.items() if (settings := _setting(name, value)))
    few = islice(found, _MAX_SETTINGS)
    return [s._replace(key=f"{before}{s.key}", text=s.text[:_MAX_SETTING]) for s in few]


def _setting(name: str, value: object) -> Setting | None:
    if isinstance(value, dict):
        entries = {k.lower(): v for k, v in value.items()}
        number = next((entries[k] for k in keys_of("value") if k in entries), None)
        unit = next((entries[k] for k in keys_of("unit") if k in entries), "")
        if number is None or isinstance(number, dict | list):
            return None
        return Setting(_clean(name), f"{_clean(str(number))} {_clean(str(unit))}".rstrip())
    if _is_number(value):
        plain, unit = without_unit(_clean(name))
        return Setting(plain, f"{value} {unit}".rstrip())
    return Setting(_clean(name), _clean(value)) if isinstance(value, str) and value else None


def _units(part: object, names: set[str], key: str, depth: int) -> Iterator[tuple[str, str]]:
    """Yield the units that an object assigns to column names."""
    if depth > _DEEPEST or not isinstance(part, dict):
        return
    own = {k: v for k, v in part.items() if k in names and isinstance(v, str)}
    names_units = len(own) > 1 or key.lower() in keys_of("unit")
    if names_units and all(is_unit_of_key(unit) for unit in own.values() if unit):
        yield from own.items()
    for name, inner in part.items():
        yield from _units(inner, names, name, depth + 1)


def _with_units(settings: list[Setting], units: dict[str, str]) -> list[Setting]:
    """Return settings with the unit stated for their name, but without those that are units."""
    found = []
    for setting in settings:
        unit = units.get(setting.key.split(" ")[-1], "")
        if unit == setting.text:
            continue
        bare = unit and re.fullmatch(r"[-+\d.eE]+", setting.text) is not None
        found.append(setting._replace(text=f"{setting.text} {unit}") if bare else setting)
    return found


def _clean(text: str) -> str:
    return " ".join(text.split())
