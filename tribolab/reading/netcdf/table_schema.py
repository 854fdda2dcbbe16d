"""Validation of data against a Table Schema of a run or scan."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.core.errors import ConfigError, ReadError, UnitError, nearest, shown
from tribolab.reading.netcdf.schema_violations import Broken, Violations
from tribolab.reading.raw.source import check_regular
from tribolab.reading.schema_folder import schema_folder
from tribolab.units.conversion import conversion

_SCHEMAS = ("run", "scan")
_TYPES = {"number": "fiub", "integer": "fiub", "boolean": "b", "string": "OUST"}


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
        Run or scan as read, or a table in SI. Columns unknown to the schema, and its optional
        columns, are ignored.
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
    empty = frozenset(rules.get("missingValues", [""]))
    broken: list[Broken] = []
    for field in rules["fields"]:
        constraints = dict(field.get("constraints", {}))
        if field["name"] in key:
            constraints["required"] = True
        if key == [field["name"]]:
            constraints["unique"] = True
        values, unit = _column(data, field["name"])
        if values is None:
            if constraints.get("required"):
                broken.append(_whole(field, "missing column", None, []))
            continue
        broken += _field_broken(field, constraints, values.ravel(), unit, empty)
    return Violations(tuple(broken))


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


def _whole(field: Mapping[str, Any], constraint: str, limit: Any, values: list[Any]) -> Broken:
    return Broken(field["name"], constraint, limit, np.empty(0, dtype=np.intp), values)


def _field_broken(
    field: Mapping[str, Any],
    constraints: Mapping[str, Any],
    values: np.ndarray,
    unit: str | None,
    empty: frozenset[str],
) -> list[Broken]:
    kind = field.get("type", "string")
    if unit is not None and "unit" in field and not _same_unit(unit, field["unit"]):
        return [_whole(field, "unit", field["unit"], [unit])]
    numeric = kind in ("number", "integer")
    if numeric and values.dtype.kind == "O":
        values, odd = _as_numbers(values, empty)
        if odd.any():
            rows = np.flatnonzero(odd)
            return [Broken(field["name"], "type", kind, rows, values[rows])]
        values = values.astype(float)
    if kind in _TYPES and values.dtype.kind not in _TYPES[kind]:
        return [_whole(field, "type", kind, [str(values.dtype)])]
    broken = []

    def report(constraint: str, limit: Any, wrong: np.ndarray) -> None:
        rows = np.flatnonzero(wrong)
        if rows.size:
            broken.append(Broken(field["name"], constraint, limit, rows, values[rows]))

    if kind == "integer" and values.dtype.kind == "f" and not _are_whole(values):
        report("type", "integer", np.isfinite(values) & (values != np.round(values)))
    for constraint, limit in constraints.items():
        wrong = _CHECKS[constraint](values, limit, empty)
        if wrong is not None:
            report(constraint, limit, wrong)
    return broken


def _as_numbers(values: np.ndarray, empty: frozenset[str]) -> tuple[np.ndarray, np.ndarray]:
    """Return values as numbers, and a mask of those that are neither numbers nor missing."""
    numbers = pd.to_numeric(pd.Series(values), errors="coerce").to_numpy()
    none = pd.isna(values) | np.isin(values.astype(str), list(empty))
    odd = np.isnan(numbers) & ~none
    return (values if odd.any() else numbers), odd


def _are_whole(values: np.ndarray) -> bool:
    return bool((values == np.round(values)).all())


def _limit_check(
    limit_of: Callable[[np.ndarray], Any], wrong: Callable[..., Any]
) -> Callable[..., Any]:
    """Return a check that compares the extreme first, as most data are within the limits."""

    def check(values: np.ndarray, limit: Any, _: frozenset[str]) -> np.ndarray | None:
        if values.dtype.kind == "f" and values.size:
            extreme = limit_of(values)  # NaN is ignored
            if not wrong(extreme, limit):
                return None
        return wrong(values, limit)

    return check


def _missing(values: np.ndarray, wanted: bool, empty: frozenset[str]) -> np.ndarray | None:
    if not wanted or values.dtype.kind in "iub":
        return None
    if values.dtype.kind == "f":
        return np.isnan(values)
    return pd.isna(values) | np.isin(values.astype(str), list(empty))


def _repeated(values: np.ndarray, wanted: bool, _: frozenset[str]) -> np.ndarray | None:
    if not wanted or (values.dtype.kind in "fiu" and bool((values[1:] > values[:-1]).all())):
        return None
    series = pd.Series(values)
    return (series.duplicated() & series.notna()).to_numpy()


def _no_match(values: np.ndarray, pattern: str, empty: frozenset[str]) -> np.ndarray:
    text = pd.Series(values).astype("string")
    return (~text.str.fullmatch(pattern).fillna(True)).to_numpy(dtype=bool)


def _not_listed(values: np.ndarray, listed: Sequence[Any], _: frozenset[str]) -> np.ndarray:
    series = pd.Series(values)
    return (~series.isin(list(listed)) & series.notna()).to_numpy()


_CHECKS: Mapping[str, Callable[[np.ndarray, Any, frozenset[str]], np.ndarray | None]] = {
    "required": _missing,
    "unique": _repeated,
    "minimum": _limit_check(np.fmin.reduce, np.less),
    "maximum": _limit_check(np.fmax.reduce, np.greater),
    "exclusiveMinimum": _limit_check(np.fmin.reduce, np.less_equal),
    "exclusiveMaximum": _limit_check(np.fmax.reduce, np.greater_equal),
    "enum": _not_listed,
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
