"""NumPy archives: named arrays are columns; single values and texts are settings."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.raw.containers.groups import plain, settings_of
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable, Setting
from tribolab.reading.raw.opening import isolated
from tribolab.reading.raw.unpacked import ZIP_DAMAGE

_NAMES = re.compile(r"(?:columns?|names?|labels?|channels?|fields?|headers?|keys)$", re.IGNORECASE)


@isolated()
def read_npz(path: Path) -> RawFile:
    """Read the named arrays of a NumPy archive as columns.

    Raises
    ------
    ReadError
        If the file is damaged, unpacks to far more than its size, or contains Python objects.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (*ZIP_DAMAGE, KeyError) as error:
        what = f"this archive of arrays cannot be read: {shown(str(error), 120)}"
        raise ReadError(what, where=path) from error
    columns, settings = _columns_of(arrays)
    return RawFile(path, "npz", (RawTable("", tuple(columns)),), tuple(settings))


def _columns_of(arrays: dict[str, np.ndarray]) -> tuple[list[RawColumn], list[Setting]]:
    columns: list[RawColumn] = []
    settings: list[Setting] = []
    names = [_texts(a) for key, a in arrays.items() if a.dtype.kind in "US" and _NAMES.search(key)]
    for key, array in arrays.items():
        if array.dtype.names:
            columns += [
                RawColumn(name, None, array[name].ravel(), path=f"{key}/{name}")
                for name in array.dtype.names
            ]
        elif array.size == 1 or array.dtype.kind in "US":
            settings += settings_of(key, plain(array), key)
        elif array.dtype.kind not in "fiubMm":
            continue
        elif array.ndim == 1 or array.size == max(array.shape, default=0):
            columns.append(RawColumn(key, None, array.ravel(), path=key))
        elif array.ndim == 2:
            table = array if array.shape[0] >= array.shape[1] else array.T
            own = next((n for n in names if len(n) == table.shape[1]), [])
            columns += [
                RawColumn(name, None, table[:, place], path=name) for place, name in enumerate(own)
            ]
    return columns, settings


def _texts(array: np.ndarray) -> list[str]:
    return [str(plain(text)) for text in array.ravel().tolist()]
