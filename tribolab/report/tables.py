"""The tables beside the page: a row per segment, point, source or finding; units in the names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from tribolab.errors import ReadError, brief
from tribolab.friction.coefficient.steadiness import WORDS
from tribolab.plot.labels import column

if TYPE_CHECKING:
    import xarray as xr

SEVERITIES = ("fail", "error", "suspect", "note")

_FRICTION_FIRST = [
    "sliding_speed",
    "direction",
    "friction_coefficient",
    "friction_coefficient_std",
    "friction_coefficient_sem",
    "effective_samples",
    "friction_force",
    "friction_force_std",
    "friction_force_sem",
    "normal_force",
    "normal_force_std",
    "half_loop",
    "pair",
    "start",
    "stop",
    "trimmed_start",
    "trimmed_stop",
    "sliding_distance",
    "samples",
]
_CURVE = [
    "sliding_speed",
    "friction_coefficient",
    "friction_coefficient_std",
    "friction_coefficient_sem",
    "friction_coefficient_within",
    "friction_coefficient_between",
    "runs",
    "segments",
]
LABELS = ["surface", "medium", "nominal_normal_force_N"]


def frame(data: xr.Dataset, dim: str, first: Sequence[str] = ()) -> pd.DataFrame:
    """Return the variables over one dimension as a table.

    Parameters
    ----------
    data
        Any result of this package.
    dim
        The dimension whose entries become rows.
    first
        Variables that stand first, in this order; the others follow as in the dataset.

    Returns
    -------
    pandas.DataFrame
        Columns are called as the variables with their unit; text stays text.
    """
    names = [str(n) for n in data.variables if data[n].dims == (dim,)]
    ordered = [n for n in first if n in names] + [n for n in names if n not in first]
    columns = {}
    for name in ordered:
        values = np.asarray(data[name])
        columns[name if values.dtype.kind in "OUS" else column(name)] = values
    return pd.DataFrame(columns)


def friction_table(friction: xr.Dataset) -> pd.DataFrame:
    """Return a run's friction result as a table, a row per segment, numbered from 1."""
    table = frame(friction, "segment", _FRICTION_FIRST)
    number = np.arange(1, friction.sizes["segment"] + 1)
    table = table.drop(columns="segment", errors="ignore")
    if "steady" in table:
        table["steady"] = table["steady"].map(WORDS)
    table.insert(0, "segment", number)
    return table


def curve_table(curve: xr.Dataset) -> pd.DataFrame:
    """Return a measured curve as a table, a row per sliding speed."""
    return frame(curve, "sliding_speed", _CURVE)


def labelled(table: pd.DataFrame, what: str, name: str, labels: dict[str, Any]) -> pd.DataFrame:
    """Put the name and the labels (surface, medium, nominal load) before a table's columns."""
    front = {what: name} | {key: labels.get(key) for key in LABELS}
    return pd.concat(
        [pd.DataFrame({key: [value] * len(table) for key, value in front.items()}), table], axis=1
    )


def together(tables: Sequence[pd.DataFrame], columns: Sequence[str]) -> pd.DataFrame:
    """Stack tables whose columns may differ; without any, an empty table with these columns."""
    filled = [table for table in tables if len(table)]
    if not filled:
        return pd.DataFrame(columns=list(columns))
    rows = [row for table in filled for row in table.to_dict("records")]
    return pd.DataFrame(rows)


def findings_table(findings: Sequence[dict[str, str]]) -> pd.DataFrame:
    """Return the findings, the gravest first, otherwise in their order."""
    table = pd.DataFrame(list(findings), columns=["severity", "run", "where", "message"])
    rank = table["severity"].map(SEVERITIES.index) if len(table) else None
    return table if rank is None else table.iloc[np.argsort(rank, kind="stable")]


def checks_table(checks: Mapping[str, Sequence[Mapping[str, Any]]]) -> pd.DataFrame:
    """Return every check of every run, also those that passed or were skipped.

    Parameters
    ----------
    checks
        By the run's name, as in report.json.
    """
    columns = ["check", "variable", "status", "value", "unit", "message"]
    rows = [{"run": run} | dict(row) for run, mine in checks.items() for row in mine]
    return pd.DataFrame(rows, columns=["run", *columns])


# What a spreadsheet takes for a formula at the beginning of a cell; and our own sign, so that
# reading undoes exactly what writing did.
_ACTIVE = tuple("=+-@\t\r\n'＝＋－＠")
_SIGN = "'"


def harmless(cell: Any) -> Any:
    r"""Return a cell that no spreadsheet computes: text that begins like a formula gets a sign.

    Numbers stay as they are, also those written as text.

    Examples
    --------
    >>> harmless("=1+1"), harmless("-3.5e2"), harmless(-3.5), harmless("sb-r")
    ("'=1+1", '-3.5e2', -3.5, 'sb-r')
    """
    if not isinstance(cell, str) or not cell.startswith(_ACTIVE):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"{_SIGN}{cell}"
    return cell


def as_it_was(cell: Any) -> Any:
    """Undo `harmless`."""
    return cell[1:] if isinstance(cell, str) and cell.startswith(_SIGN) else cell


def write(table: pd.DataFrame, path: Path, digits: int | None = None) -> None:
    """Write a table as CSV: UTF-8, LF, every float with all its digits or with so many.

    Text that a spreadsheet would compute is made `harmless`; `read` gives it back.
    """
    safe = _mapped(table, harmless)
    float_format = None if digits is None else f"%.{digits}g"
    safe.to_csv(path, index=False, encoding="utf-8", lineterminator="\n", float_format=float_format)


def read(path: Path) -> pd.DataFrame:
    """Read a table that `write` wrote.

    Raises
    ------
    ReadError
        If it is no table.
    """
    try:
        table = pd.read_csv(path, encoding="utf-8", keep_default_na=False, na_values=[""])
    except (OSError, ValueError) as error:
        raise ReadError(f"{path}: no table ({brief(error)})") from error
    return _mapped(table, as_it_was)


def _mapped(table: pd.DataFrame, how: Callable[[Any], Any]) -> pd.DataFrame:
    """Map the texts of a table and the names of its columns."""
    done = table.copy()
    for place, name in enumerate(table.columns):
        values = table.iloc[:, place]
        if values.dtype == object or pd.api.types.is_string_dtype(values):
            done[name] = values.map(how, na_action="ignore")
    return done.rename(columns=how)
