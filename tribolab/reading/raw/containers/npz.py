"""NumPy archives: named arrays are columns; single values, texts and JSON are settings.

An array of two columns, the first of which increases, is a signal with its own times; if these are
the same for all signals, they form one column, ``time``.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.raw.containers.groups import Groups
from tribolab.reading.raw.containers.settings import plain, settings_of
from tribolab.reading.raw.model import RawColumn, RawFile, Setting
from tribolab.reading.raw.opening import isolated
from tribolab.reading.raw.zip_safety import ZIP_DAMAGE

_NAMES = re.compile(r"(?:columns?|names?|labels?|channels?|fields?|headers?|keys)$", re.IGNORECASE)
_STEP = re.compile(  # step2_force, force_s03, run1/load
    r"(?:(?P<table>[^\W\d_]+[_-]?\d+)[_./-](?P<name>\D\w*)|(?P<own>\D\w*?)[_./-](?P<last>[^\W\d_]*\d+))"
)


_Columns = list[tuple[str, str, np.ndarray]]  # table, name, numbers


@isolated()
def read_npz(path: Path) -> RawFile:
    """Read the arrays of an archive.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    ReadError
        If it is damaged, unpacks to far more than its size, or contains Python objects.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (*ZIP_DAMAGE, KeyError) as error:
        what = f"this archive of arrays cannot be read: {shown(str(error), 120)}"
        raise ReadError(what, where=path) from error
    columns, settings = _columns_of(arrays)
    tables = {table for table, _, _ in columns}
    numbered = [_STEP.fullmatch(name) for table, name, _ in columns if not table]
    parts = [match for match in numbered if match is not None]
    steps = {match[match.lastgroup or 0] for match in parts}
    if tables == {""} and len(steps) > 1 and len(parts) == len(columns):
        columns = [
            (match["table"] or match["last"], match["name"] or match["own"].rstrip("_"), values)
            for match, (_, _, values) in zip(parts, columns, strict=True)
        ]
    groups = Groups()
    groups.add_settings("", settings)
    for table, name, values in columns:
        place = f"{table}/{name}" if table else name
        groups.add_column(table, RawColumn(name, None, values, path=place))
    return groups.as_file(path, "npz")


def _columns_of(arrays: dict[str, np.ndarray]) -> tuple[_Columns, list[Setting]]:
    columns: _Columns = []
    settings: list[Setting] = []
    names = [_texts(a) for key, a in arrays.items() if a.dtype.kind in "US" and _NAMES.search(key)]
    pairs: list[tuple[str, np.ndarray]] = []
    for key, array in arrays.items():
        if array.dtype.names:
            columns += [(key, field, array[field].ravel()) for field in array.dtype.names]
        elif array.size == 1 or array.dtype.kind in "US":
            settings += settings_of(key, plain(array), key)
        elif array.dtype.kind not in "fiubMm":
            continue
        elif array.ndim == 1 or array.size == max(array.shape, default=0):
            columns.append(("", key, array.ravel()))
        elif array.ndim == 2:
            table = array if array.shape[0] >= array.shape[1] else array.T
            own = next((n for n in names if len(n) == table.shape[1]), None)
            if own is not None:
                columns += [("", name, table[:, place]) for place, name in enumerate(own)]
            elif table.shape[1] == 2 and (np.diff(table[:, 0]) > 0).all():
                pairs.append((key, table))
    return columns + _on_one_clock(pairs), settings


def _on_one_clock(pairs: list[tuple[str, np.ndarray]]) -> _Columns:
    """Return signals with own times interpolated to the times of the longest one."""
    if not pairs:
        return []
    clock = max((table[:, 0] for _, table in pairs), key=len)
    columns = [("", "time", clock)]
    for key, table in pairs:
        values = np.interp(clock, table[:, 0], table[:, 1], left=np.nan, right=np.nan)
        columns.append(("", key, values))
    return columns


def _texts(array: np.ndarray) -> list[str]:
    return [str(plain(text)) for text in array.ravel().tolist()]
