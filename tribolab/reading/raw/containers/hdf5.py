"""HDF5 and MATLAB 7.3: datasets are columns, attributes and single values are settings.

A field of a MATLAB 7.3 structure array is a dataset of references to the values of its elements;
its columns are named as in MATLAB: ``stage(2)/force``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.containers.groups import Groups, plain, settings_of
from tribolab.reading.raw.hdf5_safety import foreign_storage, refused
from tribolab.reading.raw.model import RawColumn, RawFile
from tribolab.reading.raw.opening import isolated, report_damage

_OF_HDF5 = {
    *keys_of("unit"),
    *("CLASS", "NAME", "TITLE", "VERSION", "DIMENSION_LIST", "_FillValue"),
    *("MATLAB_class", "MATLAB_fields", "MATLAB_int_decode", "MATLAB_empty", "REFERENCE_LIST"),
    *("_Netcdf4Dimid", "_NCProperties", "long_name", "description", "columns", "column_names"),
}
_OF_LIBRARY = ("#refs#", "#subsystem#")
_NAMES = ("columns", "column_names", "names", "labels", "channels", "fields")
_UNITS = (*keys_of("unit"), "column_units", "Units", "Unit")
_MEANINGS = ("long_name", "description", "standard_name", "label", "title")
_MAX_ELEMENTS = 500  # most elements of a structure array that are read


@isolated("h5py")
def read_hdf5(path: Path) -> RawFile:
    """Read the columns of an HDF5 file, with attributes and single values as settings.

    Raises
    ------
    ReadError
        If the file is damaged, or refers to data outside.
    """
    # imported late: h5py loads slowly
    import h5py

    found = _Found(h5py)
    with report_damage(path, "HDF5 file"):
        with h5py.File(path, "r") as file:
            found.add_settings("", file)
            file.visititems(found.visit)
    return found.groups.as_file(path, "hdf5", sort=True)


class _Found:
    """Columns and settings found so far in a file."""

    def __init__(self, h5py: Any) -> None:
        self._h5py = h5py
        self.groups = Groups()

    def visit(self, name: str, item: Any) -> None:
        if name.startswith(_OF_LIBRARY):
            return
        self.add_settings(name, item)
        if not isinstance(item, self._h5py.Dataset) or item.size is None:
            return
        units = _first(item, _UNITS)
        meaning = _first(item, _MEANINGS)
        labels = _labels_of_matrix(item)
        if item.dtype.names:  # rows of several numbers, as in tables
            own = _split_units(units, len(item.dtype.names))
            rows = item[()]
            for place, field in enumerate(item.dtype.names):
                unit = own[place] or _of_field(item, place)
                self._add(name, str(field), rows[field], unit)
        elif labels:
            matrix = item[()]
            for place, label in enumerate(labels):
                own = _split_units(units, len(labels))
                self._add(name, label, matrix[:, place], own[place])
        elif item.dtype.kind == "O" and self._h5py.check_dtype(ref=item.dtype):
            self._elements(name, item)
        elif _is_char(item):
            return
        elif item.dtype.kind in "fiu" and item.size == max(item.shape, default=0):
            unit = units if isinstance(units, str) else None
            group, _, label = name.rpartition("/")
            self._add(group, label, item[()], unit, meaning if isinstance(meaning, str) else "")

    def add_settings(self, name: str, item: Any) -> None:
        """Store attributes and single values as settings of their group."""
        is_data = isinstance(item, self._h5py.Dataset)
        group, own = name, name.rsplit("/", 1)[-1]
        if is_data and not item.dtype.names:
            group = name.rpartition("/")[0]
        for key, value in getattr(item, "attrs", {}).items():
            if key not in _OF_HDF5 and not key.startswith(("FIELD_", "_nc", "_Netcdf4")):
                if np.size(value) == 1:
                    self._add_setting(group, key, value)
        if is_data and item.size == 1 and item.dtype.kind in "fiu" and not _is_char(item):
            unit = _first(item, _UNITS)
            text = f"{plain(item[()])} {unit if isinstance(unit, str) else ''}".strip()
            self._add_setting(group, own, text)
        elif is_data and item.shape == () and item.dtype.kind in "OS":
            self._add_setting(group, own, item[()])
        elif is_data and _is_char(item):
            self._add_setting(group, own, _matlab_text(item))

    def _add_setting(self, group: str, key: str, value: object) -> None:
        self.groups.add_settings(group, settings_of(key, value, group))

    def _add(
        self, group: str, label: str, values: np.ndarray, unit: object, meaning: str = ""
    ) -> None:
        single = values.dtype.kind not in "fiu" or values.size < 2
        if single or values.size != max(values.shape):
            return  # text, a single value, or several columns
        unit_text = str(unit) if unit is not None else None
        path = f"{group}/{label}" if group else label
        self.groups.add_column(group, RawColumn(label, unit_text, values.ravel(), meaning, path))

    def _elements(self, name: str, item: Any) -> None:
        """Read a field of a structure array, whose elements are stored in other datasets."""
        group, _, field = name.rpartition("/")
        for number, reference in enumerate(item[()].ravel()[:_MAX_ELEMENTS], start=1):
            target = item.file[reference] if reference else None
            if not isinstance(target, self._h5py.Dataset):
                continue
            if what := foreign_storage(
                self._h5py, target.id
            ):  # the check of links does not see references
                raise refused(Path(item.file.filename), f"{name}({number})", what)
            element = f"{group}({number})" if group else f"({number})"
            if _is_char(target):
                self._add_setting(element, field, _matlab_text(target))
            elif target.dtype.kind in "fiu" and target.size == 1:
                self._add_setting(element, field, plain(target[()]))
            elif target.dtype.kind in "fiu" and target.size:
                self._add(element, field, target[()], None)


def _is_char(item: Any) -> bool:
    return bool(plain(item.attrs.get("MATLAB_class", "")) == "char")


def _matlab_text(item: Any) -> str:
    """Return text that is stored as character codes."""
    if item.attrs.get("MATLAB_empty", 0) or item.dtype.kind not in "u":
        return ""
    return "".join(chr(code) for code in np.asarray(item[()]).T.ravel()[:500].tolist())


def _first(item: Any, keys: Sequence[str]) -> object:
    """Return the text, or list of texts, in the first attribute that exists; else None."""
    for key in keys:
        if key in item.attrs:
            value = plain(item.attrs[key])
            if isinstance(value, list):
                value = [plain(each) for each in value]
            if isinstance(value, str) and value.strip() or isinstance(value, list):
                return value
    return None


def _split_units(units: object, width: int) -> list[str | None]:
    """Return the units of a table's columns, from a list or a text that lists them."""
    if isinstance(units, str):
        mark = next((mark for mark in (";", ",", "\t", "|") if mark in units), " ")
        units = [unit.strip() for unit in units.split(mark)]
    if not isinstance(units, list) or len(units) != width:
        return [None] * width
    return [str(unit).strip() or None for unit in units]


def _of_field(item: Any, place: int) -> str | None:
    unit_text = plain(item.attrs.get(f"FIELD_{place}_UNITS", item.attrs.get(f"FIELD_{place}_UNIT")))
    return str(unit_text) if unit_text is not None else None


def _labels_of_matrix(item: Any) -> list[str]:
    """Return the column names of a matrix that its attributes state; else an empty list."""
    if len(item.shape) != 2 or item.dtype.names:
        return []
    for key in _NAMES:
        if key not in item.attrs:
            continue
        names = plain(item.attrs[key])
        if isinstance(names, str):
            names = [text.strip() for text in names.replace(";", ",").split(",")]
        if isinstance(names, list) and len(names) == item.shape[1]:
            return [str(plain(text)) for text in names]
    return []
