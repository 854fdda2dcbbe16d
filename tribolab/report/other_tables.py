"""Tables of a results folder in other formats: an Excel workbook, or Parquet."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pandas as pd

from tribolab.core.errors import OutputError
from tribolab.figures.labels import column
from tribolab.report.tables import read_csv
from tribolab.units.quantities import QUANTITIES

WORKBOOK = "tables.xlsx"
_MAX_ROWS = 1_048_574  # most rows of a sheet in Excel, minus those of names and units
_ENDINGS = {column(name)[len(name) + 1 :]: known.unit for name, known in QUANTITIES.items()}
_ENDINGS = {ending: unit for ending, unit in _ENDINGS.items() if ending}


def unit_of(name: str) -> str:
    """Return the unit at the end of a column's name; "" for a text or pure number.

    Examples
    --------
    >>> unit_of("friction_force_N"), unit_of("sliding_speed_m_s"), unit_of("surface")
    ('N', 'm/s', '')
    """
    endings = [ending for ending in _ENDINGS if name.endswith(f"_{ending}")]
    return _ENDINGS[max(endings, key=len)] if endings else ""


def write_other_tables(folder: Path, form: str) -> None:
    """Write the CSV tables of a folder in another format next to them.

    Parameters
    ----------
    folder
        Folder with the CSV tables.
    form
        ``"xlsx"`` (``tables.xlsx``: a sheet per table, units in the second row), ``"parquet"`` (a
        file per table), or ``"csv"`` (nothing is written).

    Raises
    ------
    OutputError
        If the required package is not installed.
    """
    if form == "csv":
        return
    made = {file.stem: read_csv(file) for file in sorted(folder.glob("*.csv"))}
    if form == "parquet":
        for name, table in made.items():
            empty = dict.fromkeys(table.columns[table.isna().all()], "float64")
            table.astype(empty).to_parquet(folder / f"{name}.parquet", index=False)
        return
    if importlib.util.find_spec("openpyxl") is None:
        raise OutputError("--tables xlsx needs openpyxl: python -m pip install 'tribolab[formats]'")
    with pd.ExcelWriter(folder / WORKBOOK, engine="openpyxl") as book:
        for name, table in made.items():
            row = [unit_of(str(each)) for each in table]
            row[0] = row[0] or "unit"  # no sheet starts with an empty cell
            units = pd.DataFrame([row], columns=table.columns)
            sheet = pd.concat([units, table.head(_MAX_ROWS).astype(object)], ignore_index=True)
            sheet.to_excel(book, sheet_name=name[:31], index=False)
