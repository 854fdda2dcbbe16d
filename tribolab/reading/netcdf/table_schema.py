"""Validation of data against a Table Schema of a run or scan."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.core.errors import ConfigError, ReadError, UnitError, nearest, shown
from tribolab.reading.raw.source import check_regular
from tribolab.reading.schema_folder import schema_folder
from tribolab.units.conversion import conversion

_SCHEMAS = ("run", "scan")
_TYPES = {"number": "fiub", "integer": "fiub", "boolean": "b", "string": "OUST"}
_SCREEN = 20  # violations shown


class Violation(NamedTuple):
    """Value that violates a rule; `row` counts from 0 and is None for a whole column."""

    row: int | None
    column: str
    value: object
    constraint: str
    limit: object

    def __str__(self) -> str:
        """Return the violation as one line."""
        if self.constraint == "missing column":
            return f"column '{shown(self.column)}' is missing"
        where = f"column '{shown(self.column)}'" + ("" if self.row is None else f", row {self.row}")
        if self.constraint == "unique":
            return f"{where}: {_short(self.value)} stands there before"
        if self.constraint == "required":
            return f"{where}: a value is required"
        return f"{where}: {_short(self.value)}, but {self.constraint} is {_short(self.limit)}"


class _Broken(NamedTuple):
    """All violations of one rule in one column."""

    rows: Any
    column: str
    values: Any
    constraint: str
    limit: object

    def table(self, most: int | None = None) -> pd.DataFrame:
        """Return the first violations as rows; by default all."""
        limit = str(self.limit) if isinstance(self.limit, list | tuple) else self.limit
        parts = (self.rows[:most], self.column, self.values[:most], self.constraint, limit)
        return pd.DataFrame(dict(zip(Violation._fields, parts, strict=True)), dtype=object)


class Violations(NamedTuple):
    """All violations, by rule; empty and false if the data conform."""

    broken: tuple[_Broken, ...]

    def __bool__(self) -> bool:
        """Whether any rule is broken."""
        return bool(self.broken)

    @property
    def total(self) -> int:
        """Number of violations."""
        return sum(len(broken.rows) for broken in self.broken)

    def first(self, number: int = _SCREEN) -> list[Violation]:
        """Return the first violations, at least one for each rule."""
        share = max(number // max(len(self.broken), 1), 1)
        rows = (row for rule in self.broken for row in rule.table(share).itertuples(index=False))
        return [Violation._make(row) for row in islice(rows, number)]

    def table(self) -> pd.DataFrame:
        """Return every violation as a row: row, column, value, constraint, limit."""
        parts = [rule.table() for rule in self.broken]
        empty = pd.DataFrame(columns=Violation._fields)
        return pd.concat(parts, ignore_index=True) if parts else empty

    def __str__(self) -> str:
        """Return the first violations, a line each, and the number of further ones."""
        lines = list(map(str, self.first()))
        if more := self.total - len(lines):
            lines.append(f"and {more:,} more".replace(",", " "))
        return "\n".join(lines) or "as the schema says"


def _short(value: object) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "no value" if value is None else str(value)


def load_schema(schema: str | Path | Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a Table Schema: ``"run"``, ``"scan"``, a JSON file, or its content.

    Raises
    ------
    ConfigError
        If the schema does not exist, or contains a rule that cannot be checked.

    Examples
    --------
    >>> [field["name"] for field in load_schema("scan")["fields"]]
    ['x', 'y', 'height', 'scan']
    """
    if isinstance(schema, Mapping):
        _check_schema(schema, "the schema")
        return schema
    if str(schema) in _SCHEMAS:
        return _load(schema_folder() / f"{schema}.schema.json")
    path = Path(schema)
    if path.suffix != ".json":
        raise ConfigError(
            f"no schema is called '{shown(str(schema))}'{nearest(str(schema), _SCHEMAS)}; one of "
            "your own is given by its path, ending in .json"
        )
    return _load(path)


def validate(
    data: xr.Dataset | pd.DataFrame, schema: str | Path | Mapping[str, Any] = "run"
) -> Violations:
    """Check data against a Table Schema.

    Parameters
    ----------
    data
        Run or scan as read, or a table in SI. Columns that the schema does not list
        are ignored, and its optional columns may be missing.
    schema
        As for `load_schema`.

    Returns
    -------
    Violations
        Every value that violates a rule, with row, column, value and limit; false without any. In
        data of several dims the row is the position in the flattened array.

    Raises
    ------
    ConfigError
        If the schema does not exist, or contains a rule that cannot be checked.

    Examples
    --------
    >>> table = pd.DataFrame({"time": [0.0, 1.0, 1.0], "normal_force": [1.0, -2e6, 1.0]})
    >>> found = validate(table)
    >>> print(found)
    column 'time', row 2: 1 stands there before
    column 'normal_force', row 1: -2e+06, but minimum is -1000
    """
    rules = load_schema(schema)
    key = rules.get("primaryKey", [])
    key = [key] if isinstance(key, str) else list(key)
    empty = list(rules.get("missingValues", [""]))
    found: list[_Broken] = []
    for field in rules["fields"]:
        name, constraints = field["name"], dict(field.get("constraints", {}))
        constraints |= {"required": True} if name in key else {}
        constraints |= {"unique": True} if key == [name] else {}
        values, unit = _column(data, name)
        if values is not None:
            found += _broken(field, constraints, values.ravel(), unit, empty)
        elif constraints.get("required"):
            found.append(_Broken([None], name, [None], "missing column", None))
    return Violations(tuple(found))


def _column(data: xr.Dataset | pd.DataFrame, name: str) -> tuple[np.ndarray | None, str | None]:
    """Return the values of a column, and its stated unit."""
    if isinstance(data, xr.Dataset):
        if name not in data.variables:
            return None, None
        return data[name].to_numpy(), data[name].attrs.get("units")
    if name in data.columns:
        return data[name].to_numpy(), None
    if name in data.index.names:
        return data.index.get_level_values(name).to_numpy(), None
    return None, None


def _broken(
    field: Mapping[str, Any],
    constraints: Mapping[str, Any],
    values: np.ndarray,
    unit: str | None,
    empty: list[str],
) -> Iterator[_Broken]:
    """Yield the violations in a column; after a wrong unit or type, no other rule is checked."""
    name, kind = field["name"], field.get("type", "string")
    if unit is not None and "unit" in field and not _same_unit(unit, field["unit"]):
        yield _Broken([None], name, [unit], "unit", field["unit"])
        return
    none = _is_missing(values, empty)
    odd = np.zeros(values.size, dtype=bool)
    if kind in ("number", "integer") and values.dtype.kind == "O":
        numbers = pd.to_numeric(pd.Series(values), errors="coerce").to_numpy(dtype=float)
        odd = np.isnan(numbers) & ~none
        values = values if odd.any() else numbers
    if kind in _TYPES and values.dtype.kind not in _TYPES[kind] and not odd.any():
        yield _Broken([None], name, [str(values.dtype)], "type", kind)
        return
    checks: dict[str, tuple[Any, np.ndarray]] = {"type": (kind, odd)}
    if not odd.any():
        if kind == "integer" and values.dtype.kind == "f":
            checks["type"] = kind, np.isfinite(values) & (values != np.round(values))
        for constraint, limit in constraints.items():
            checks[constraint] = limit, _CHECKS[constraint](values, limit, none)
    for constraint, (limit, wrong) in checks.items():
        if (rows := np.flatnonzero(wrong)).size:
            yield _Broken(rows, name, values[rows], constraint, limit)


def _is_missing(values: np.ndarray, empty: list[str]) -> np.ndarray:
    if values.dtype.kind in "fiub":
        return np.isnan(values)
    return np.asarray(pd.isna(values) | np.isin(values.astype(str), empty))


def _repeated(values: np.ndarray, wanted: bool, none: np.ndarray) -> np.ndarray:
    rises = values.dtype.kind in "fiu" and bool((values[1:] > values[:-1]).all())
    return (
        none & False if rises or not wanted else pd.Series(values).duplicated().to_numpy() & ~none
    )


def _no_match(values: np.ndarray, pattern: str, none: np.ndarray) -> np.ndarray:
    text = pd.Series(values).astype("string")
    return (~text.str.fullmatch(pattern).fillna(True)).to_numpy(dtype=bool)


_CHECKS: Mapping[str, Callable[[np.ndarray, Any, np.ndarray], np.ndarray]] = {
    "required": lambda values, wanted, none: none & wanted,
    "unique": _repeated,
    "minimum": lambda values, limit, none: values < limit,
    "maximum": lambda values, limit, none: values > limit,
    "exclusiveMinimum": lambda values, limit, none: values <= limit,
    "exclusiveMaximum": lambda values, limit, none: values >= limit,
    "enum": lambda values, listed, none: ~np.isin(values, listed) & ~none,
    "pattern": _no_match,
}


@functools.lru_cache(maxsize=16)
def _load(path: Path) -> Mapping[str, Any]:
    try:
        check_regular(path)
        schema = json.loads(path.read_text(encoding="utf-8"))
    except ReadError as error:
        raise ConfigError(error) from error
    except (OSError, ValueError) as error:
        raise ConfigError(f"{path}: the schema cannot be read: {error}") from error
    _check_schema(schema, str(path))
    return schema


def _check_schema(schema: Mapping[str, Any], where: str) -> None:
    fields = schema.get("fields") if isinstance(schema, Mapping) else None
    if not isinstance(fields, list) or not all(isinstance(f, dict) and "name" in f for f in fields):
        raise ConfigError(f"{where}: a Table Schema has 'fields', a list, each with a 'name'")
    for field in fields:
        for constraint in field.get("constraints", {}):
            if constraint not in _CHECKS:
                raise ConfigError(
                    f"{where}: field '{shown(field['name'])}': the constraint "
                    f"'{shown(constraint)}' cannot be checked{nearest(constraint, _CHECKS)}"
                )


@functools.lru_cache(maxsize=256)
def _same_unit(stated: str, wanted: str) -> bool:
    if stated == wanted:
        return True
    try:
        return conversion(stated, wanted) == (1.0, 0.0)
    except UnitError:
        return False
