"""Reading and writing of CSV tables, with texts escaped so that spreadsheets compute nothing."""

from __future__ import annotations

import csv
import itertools
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

import pandas as pd

from tribolab.core.errors import ReadError, brief
from tribolab.core.provenance import escape_controls
from tribolab.records.parts import Row

_CHUNK = 4_000  # rows in memory at once
SEVERITIES = ("fail", "error", "suspect", "note")

CURVE_LABELS = ["surface", "medium", "nominal_normal_force_N"]

# characters that start a formula in spreadsheets; also the escape sign itself, so that a text that
# starts with it survives writing and reading
_ACTIVE = tuple("=+-@\t\r\n'＝＋－＠")
_SIGN = "'"


def uncomputed(cell: Any) -> Any:
    r"""Return a cell with a leading ' if a spreadsheet would compute its text as a formula.

    Numbers, including numbers as text, remain unchanged. Control characters are escaped.

    Examples
    --------
    >>> uncomputed("=1+1"), uncomputed("-3.5e2"), uncomputed(-3.5), uncomputed("sb-r")
    ("'=1+1", '-3.5e2', -3.5, 'sb-r')
    """
    if not isinstance(cell, str):
        return cell
    cell = escape_controls(cell)
    if not cell.startswith(_ACTIVE):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"{_SIGN}{cell}"
    return cell


def as_it_was(cell: Any) -> Any:
    """Return the original text of a cell that `uncomputed` has escaped."""
    return cell[1:] if isinstance(cell, str) and cell.startswith(_SIGN) else cell


def write_csv(table: pd.DataFrame, path: Path, digits: int | None = None) -> None:
    """Write a table as CSV in UTF-8, with all digits of floats or the given number of digits.

    Text that a spreadsheet would compute is escaped by `uncomputed`; `read_csv` restores it.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        _append(table, file, header=True, digits=digits)


def write_rows(rows: Callable[[], Iterable[Row]], path: Path, columns: Sequence[str]) -> None:
    """Write a long table as CSV without loading it into memory.

    Parameters
    ----------
    rows
        Function that yields the rows each time it is called. Missing columns are left empty.
    path
        The CSV file.
    columns
        Columns of a table without rows; without rows and columns nothing is written.
    """
    types = _types(rows()) or dict.fromkeys(columns, "object")
    if not types:
        return
    with path.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(map(uncomputed, types))
        for part in _batches(rows(), _CHUNK):
            values = {name: [row.get(name) for row in part] for name in types}
            texts = [_texts(values[name], dtype) for name, dtype in types.items()]
            lines.writerows(zip(*texts, strict=True))


def _texts(values: Sequence[Any], dtype: str) -> list[Any]:
    """Return the cells of a column as text for CSV; missing ones are empty."""
    if dtype == "float64":
        return ["" if v is None or v != v else repr(float(v)) for v in values]
    if dtype == "object":
        return ["" if v is None or v != v else uncomputed(v) for v in values]
    return list(values)


def _types(rows: Iterable[Row]) -> dict[str, str]:
    """Return the numpy type of each column; columns are in the order of their first appearance."""
    kinds: dict[str, set[type]] = {}
    seen: Counter[str] = Counter()
    count = 0
    for row in rows:
        count += 1
        for name, value in row.items():
            kinds.setdefault(name, set()).add(type(value))
            seen[name] += 1
    return {
        name: _dtype(kind if seen[name] == count else kind | {type(None)})
        for name, kind in kinds.items()
    }


def _batches(rows: Iterable[Row], size: int) -> Iterator[list[Row]]:
    every = iter(rows)
    while part := list(itertools.islice(every, size)):
        yield part


def _dtype(kinds: set[type]) -> str:
    known = kinds - {type(None)}
    if known <= {int}:
        return "int64" if type(None) not in kinds and known else "float64"
    if known <= {int, float}:
        return "float64"
    return "bool" if kinds == {bool} else "object"


def _append(
    table: pd.DataFrame, file: IO[str], *, header: bool = False, digits: int | None = None
) -> None:
    float_format = None if digits is None else f"%.{digits}g"
    safe = _mapped(table, uncomputed)
    safe.to_csv(file, index=False, header=header, lineterminator="\n", float_format=float_format)


def read_csv(path: Path) -> pd.DataFrame:
    """Read a table written by `write_csv` or `write_rows`.

    Raises
    ------
    ReadError
        If the file is not a table.
    """
    try:
        table = pd.read_csv(path, encoding="utf-8", keep_default_na=False, na_values=[""])
    except (OSError, ValueError) as error:
        raise ReadError(f"{path}: no table ({brief(error)})") from error
    return _mapped(table, as_it_was)


def _mapped(table: pd.DataFrame, how: Callable[[Any], Any]) -> pd.DataFrame:
    """Return a table with a function applied to its texts and column names."""
    done = table.copy(deep=False)
    for place, dtype in enumerate(table.dtypes):
        if pd.api.types.is_object_dtype(dtype) or pd.api.types.is_string_dtype(dtype):
            done[table.columns[place]] = table.iloc[:, place].map(how, na_action="ignore")
    done.columns = done.columns.map(how)
    return done
