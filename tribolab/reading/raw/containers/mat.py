"""MAT files of version 5 to 7, read by SciPy: variables are columns, structures are tables."""

from __future__ import annotations

import contextlib
import warnings
import zlib
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.containers.groups import Groups, settings_of
from tribolab.reading.raw.model import RawColumn, RawFile
from tribolab.reading.raw.opening import isolated, largest_unpacked, report_damage

_DEEPEST = 8  # deepest nesting of structures
_MAX_ELEMENTS = 500  # most elements of a structure array that are read
_MAX_TEXT = 2000  # most characters of a text
_MAX_CELLS = 200  # most texts of a cell array
_HEADER, _COMPRESSED = 128, 15  # bytes before the variables, and type code of a compressed one
_STATED = 64  # compressed bytes sufficient to read type and length


class Variable(NamedTuple):
    """Variable with its name and numbers (None for text, cells and complex arrays).

    A field of a structure is named as in MATLAB: ``data.force``, or ``data(2).force`` in
    an array of structures. `texts` are its text, or the texts of its cells.
    """

    name: str
    numbers: np.ndarray | None
    texts: tuple[str, ...] = ()


@isolated("scipy.io")
def read_variables(path: Path) -> list[Variable]:
    """Read the variables of a MAT file.

    Parameters
    ----------
    path
        File that begins with ``MATLAB 5.0`` (versions 5 to 7).

    Returns
    -------
    list of Variable
        Variables in the order of the file.

    Raises
    ------
    ReadError
        If the file is damaged or incomplete.
    """
    # imported late: SciPy loads slowly
    from scipy.io import loadmat

    _refuse_bomb(path)
    with report_damage(path, "MAT file"), warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        content = loadmat(path, appendmat=False, mat_dtype=True)
        # with MATLAB's own types, SciPy would drop imaginary parts
        if any(issubclass(warning.category, np.exceptions.ComplexWarning) for warning in warned):
            content = loadmat(path, appendmat=False)
        found = [
            variable
            for name, value in content.items()
            if not name.startswith("__")
            for variable in _variables(name, value, 0)
        ]
    if not found:
        raise ReadError("the MAT file is cut short: it holds no variable", where=path)
    return found


def _refuse_bomb(path: Path) -> None:
    """Raise if the compressed variables state larger sizes than a file may unpack to."""
    with path.open("rb") as file:
        place, unpacked, size = _HEADER, 0, file.seek(0, 2)
        file.seek(_HEADER - 2)
        order: Literal["little", "big"] = "little" if file.read(2) == b"IM" else "big"
        while place < size:
            file.seek(place)
            head = file.read(8 + _STATED)
            kind, length = (int.from_bytes(head[at : at + 4], order) for at in (0, 4))
            if kind == _COMPRESSED:
                with contextlib.suppress(zlib.error):  # SciPy reports the damage
                    inner = zlib.decompressobj().decompress(head[8:], 8)
                    unpacked += int.from_bytes(inner[4:], order)
            place += 8 + length
    if unpacked > largest_unpacked(size):
        raise ReadError(f"its variables unpack to {unpacked / 1e6:.0f} MB", where=path)


def _variables(name: str, value: Any, depth: int) -> list[Variable]:
    """Return a value as a variable, or a structure as one variable per field."""
    # imported late: SciPy loads slowly
    from scipy.io.matlab import MatlabFunction, MatlabOpaque

    if isinstance(value, MatlabFunction | MatlabOpaque):
        return [Variable(name, None)]
    if value.dtype.names and depth < _DEEPEST and value.size <= _MAX_ELEMENTS:
        return [
            variable
            for number, element in enumerate(value.ravel(order="F"), start=1)
            for field in value.dtype.names
            for variable in _variables(
                f"{name}({number}).{field}" if value.size > 1 else f"{name}.{field}",
                element[field],
                depth + 1,
            )
        ]
    if value.dtype.kind == "U":
        return [
            Variable(name, None, tuple(str(x).strip("\0 ")[:_MAX_TEXT] for x in value.flat[:1]))
        ]
    if value.dtype.kind == "O":
        cells = [c for c in value.flat if isinstance(c, np.ndarray)]
        alone = all(cell.dtype.kind == "U" and cell.size == 1 for cell in cells)
        return [Variable(name, None, tuple(c.item() for c in cells[:_MAX_CELLS] if alone))]
    if value.dtype.kind == "b":
        value = value.astype(np.uint8)
    return [Variable(name, value if value.dtype.kind in "fiu" else None)]


def read_mat(path: Path) -> RawFile:
    """Read the variables of a MAT file as columns, and structures as tables.

    Raises
    ------
    ReadError
        If the file is damaged or incomplete.
    """
    groups = Groups()
    for variable in read_variables(path):
        folder, _, name = variable.name.rpartition(".")
        numbers = variable.numbers
        if numbers is None or numbers.size == 1:
            key = f"{name}_unit" if folder.rsplit(".", 1)[-1].lower() in _OF_UNITS else name
            text: object = numbers if numbers is not None else list(variable.texts)
            groups.add_settings(folder, settings_of(key, text, variable.name))
        elif numbers.size and numbers.size == max(numbers.shape):
            groups.add_column(folder, RawColumn(name, None, numbers.ravel(), path=variable.name))
    return groups.as_file(path, "mat")


_OF_UNITS = keys_of("unit")
