"""Files that hold columns by name: workbooks, TDMS, HDF5, Parquet, Feather, records of bytes."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from layouts.kinds import LayoutKind, add_kind, on_disc, there_and_back
from layouts.record import MeasuredRecord
from layouts.tables import Cells, friction_of, normal_of, position_of, time_of

_RECORD = ("<f8", "<f4", "<f4", "<f4")
_HEAD = b"RIG 7\0".ljust(128, b"\0")


def _columns(record: MeasuredRecord) -> list[Cells]:
    return [time_of(record), friction_of(record), normal_of(record), position_of(record)]


def _frame(record: MeasuredRecord) -> pd.DataFrame:
    return pd.DataFrame({f"{c.name} [{c.unit}]": c.values for c in _columns(record)})


def _parquet(record: MeasuredRecord, folder: Path) -> Path:
    _frame(record).to_parquet(folder / "run.parquet")
    return folder / "run.parquet"


def _feather(record: MeasuredRecord, folder: Path) -> Path:
    _frame(record).to_feather(folder / "run.feather")
    return folder / "run.feather"


def _zipped(record: MeasuredRecord, folder: Path) -> Path:
    file, packed = _parquet(record, folder), folder / "run.zip"
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(file, file.name)
    file.unlink()
    return packed


def _workbook(record: MeasuredRecord, folder: Path) -> Path:
    path = folder / "run.xlsx"
    with pd.ExcelWriter(path) as book:
        about = {"Operator": ["A. Person"], "Test": ["friction"]}
        pd.DataFrame(about).to_excel(book, sheet_name="About", index=False)
        _frame(record).to_excel(book, sheet_name="Data", index=False)
    return path


def _settings_sheet(record: MeasuredRecord, folder: Path) -> Path:
    """Say the radius of the track in a sheet of its own, and of the speed the turns alone."""
    path = folder / "disc.xlsx"
    turns = 60 * record.motion.velocity / 25e-3 / (2 * np.pi)
    columns = [time_of(record), friction_of(record), normal_of(record)]
    columns.append(Cells("Rotation", "rpm", turns, 3))
    with pd.ExcelWriter(path) as book:
        settings = pd.DataFrame({"Setting": ["Track radius [mm]"], "Value": [25]})
        settings.to_excel(book, sheet_name="Settings", index=False)
        table = pd.DataFrame({f"{c.name} [{c.unit}]": c.values for c in columns})
        table.to_excel(book, sheet_name="Data", index=False)
    return path


def _hdf5(record: MeasuredRecord, folder: Path) -> Path:
    # late: h5py takes long to load
    import h5py

    path = folder / "run.h5"
    with h5py.File(path, "w") as file:
        for column in _columns(record):
            made = file.create_dataset(f"log/{column.name}", data=column.values)
            made.attrs["units"] = column.unit
    return path


def _tdms(record: MeasuredRecord, folder: Path) -> Path:
    # late: nptdms takes long to load
    from nptdms import ChannelObject, TdmsWriter

    path = folder / "run.tdms"
    with TdmsWriter(path) as file:
        file.write_segment(
            [ChannelObject("Log", f"{c.name} ({c.unit})", c.values) for c in _columns(record)]
        )
    return path


def _records(record: MeasuredRecord, folder: Path) -> Path:
    columns = _columns(record)
    kinds = list(zip((c.name.replace(" ", "_") for c in columns), _RECORD, strict=True))
    rows = np.zeros(record.motion.time.size, dtype=kinds)
    for (name, _), column in zip(kinds, columns, strict=True):
        rows[name] = column.values
    path = folder / "run.dat"
    path.write_bytes(_HEAD + rows.tobytes())
    return path


def _dialect(
    form: str, more: str = "", name: Callable[[str], str] = str, units: bool = False
) -> str:
    """Return what a person writes who knows the columns' names."""
    columns = {
        "time": ("Time", "s"),
        "friction_force": ("Friction force", "N"),
        "normal_force": ("Normal force", "N"),
        "position": ("Position", "mm"),
    }
    text = f'name = "rig"\ntitle = "rig"\nformat = "{form}"\n[speed]\nsource = "position"\n{more}'
    for key, (label, unit) in columns.items():
        text += f'[[column]]\nquantity = "{key}"\nname = "{name(label)}"\n'
        text += f'unit = "{unit}"\n' if units else ""
        text += 'group = "Log"\n' if form == "tdms" else ""
    return text


_FIELDS = ", ".join(
    f'"{name} {kind}"'
    for name, kind in zip(
        ("Time", "Friction_force", "Normal_force", "Position"), _RECORD, strict=True
    )
)
_BINARY = _dialect(
    "binary",
    f"[binary]\noffset = {len(_HEAD)}\nfields = [{_FIELDS}]\n",
    lambda label: label.replace(" ", "_"),
    units=True,
)
add_kind(
    LayoutKind("settings_sheet", "Excel, settings in a separate sheet", on_disc, _settings_sheet)
)
_SHEET = _dialect("excel", '[header]\nline = 1\nsheet = "Data"\n')
for _name, _about, _write, _known in (
    ("workbook", "Excel, the second sheet", _workbook, _SHEET),
    ("tdms", "TDMS, channels of a group", _tdms, _dialect("tdms")),
    ("hdf5", "HDF5, paths, units as attributes", _hdf5, _dialect("hdf5", name="log/{}".format)),
    ("parquet", "Parquet", _parquet, _dialect("parquet")),
    ("feather", "Feather", _feather, _dialect("feather")),
    ("zipped", "Parquet in a zip", _zipped, _dialect("parquet")),
    ("records", "binary records after a header", _records, _BINARY),
):
    add_kind(LayoutKind(_name, _about, there_and_back, _write, dialect=_known))
