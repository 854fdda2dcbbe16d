"""MAT files of version 5 to 7, without native code: a damaged file is an error, never a crash."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.errors import ReadError, brief
from tribolab.reading.raw.opening import isolated

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_TYPES = dict(
    zip((1, 2, 3, 4, 5, 6, 7, 9, 12, 13), "i1 u1 i2 u2 i4 u4 f4 f8 i8 u8".split(), strict=True)
)
_CLASSES = dict(zip(range(6, 16), "f8 f4 i1 u1 i2 u2 i4 u4 i8 u8".split(), strict=True))
_COMPLEX = 0x0800
_CELLS, _STRUCTURE, _TEXT = 1, 2, 4
_LETTERS = {2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16"}  # u1, u2, and as UTF
_DEEPEST = 8  # structures within structures
_MOST_ELEMENTS = 500  # of an array of structures
_LONGEST = 2000  # letters of a text
_MOST_CELLS = 200  # texts of cells


class Variable(NamedTuple):
    """One variable: its name, and its numbers (None: text, cells, a complex array).

    A field of a structure is called as in MATLAB: ``data.force``, of an array of structures
    ``data(2).force``. `text` is what a text says, `texts` what cells of texts say.
    """

    name: str
    numbers: np.ndarray | None
    text: str = ""
    texts: tuple[str, ...] = ()


@isolated()
def read_variables(path: Path) -> list[Variable]:
    """Read the variables of a MAT file.

    Parameters
    ----------
    path
        A file that begins with ``MATLAB 5.0``, as versions 5, 6 and 7 do.

    Returns
    -------
    list of Variable
        In the file's order.

    Raises
    ------
    ReadError
        If the file is damaged or cut short.

    Notes
    -----
    SciPy's reader is native code that trusts the sizes in the file: a flipped byte can end the
    whole program. Here every size is held against what is there.
    """
    try:
        content = memoryview(path.read_bytes())
        order = {b"IM": "<", b"MI": ">"}.get(bytes(content[126:_HEADER]))
        if order is None:
            raise ValueError("the mark of its byte order is missing")
        variables = []
        for kind, data in _elements(content[_HEADER:], order):
            if kind == _COMPRESSED:
                inner = list(_elements(memoryview(zlib.decompress(data)), order))
                if len(inner) != 1:
                    raise ValueError(f"{len(inner)} variables stand where one should")
                kind, data = inner[0]
            if kind == _MATRIX:
                variables += _variables(data, order)
        if not variables:
            raise ValueError("it holds no variable")
    except (ValueError, struct.error, zlib.error, OSError, MemoryError) as error:
        raise ReadError(
            f"{path}: the MAT file is damaged or cut short: {brief(error)}; copy or save it again"
        ) from error
    return variables


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Type and data of the elements that stand one after the other."""
    place = 0
    while place < len(content):
        kind, size = struct.unpack_from(order + "II", content, place)
        if kind >> 16:  # a short element: type and size share four bytes, the data the next four
            kind, size, start = kind & 0xFFFF, kind >> 16, place + 4
            after = place + 8
            if size > 4:
                raise ValueError(f"a short element claims {size} bytes")
        else:
            start = place + 8
            # all but compressed elements are filled up to multiples of eight bytes
            after = start + size + (0 if kind == _COMPRESSED else -size % 8)
        if start + size > len(content):
            raise ValueError(f"an element of {size} bytes goes beyond its end")
        yield kind, content[start : start + size]
        place = after


def _variables(data: memoryview, order: str, within: str = "", depth: int = 0) -> list[Variable]:
    """Return the variable that an element holds; of a single structure its fields."""
    parts = list(_elements(data, order))
    if len(parts) < 3:
        raise ValueError("a variable has no name")
    flags = _numbers(parts[0], order)
    shape = _numbers(parts[1], order)
    name = within or bytes(parts[2][1]).decode("utf-8", errors="replace").rstrip("\0")
    if len(flags) < 1 or len(shape) < 2 or (shape < 0).any():
        raise ValueError(f"the size of variable '{name[:40]}' is not given")
    kind = int(flags[0]) & 0xFF
    if kind == _STRUCTURE and 0 < shape.prod() and len(parts) > 4 and depth < _DEEPEST:
        if shape.prod() <= _MOST_ELEMENTS:
            return _fields(name, parts, order, depth, int(shape.prod()))
    if kind == _TEXT and len(parts) > 3:
        return [Variable(name, None, _letters(parts[3], shape, order))]
    if kind == _CELLS and depth < _DEEPEST and len(parts) - 3 <= _MOST_CELLS:
        cells = [_variables(d, order, name, depth + 1) for k, d in parts[3:] if k == _MATRIX and d]
        texts = tuple(cell[0].text for cell in cells if len(cell) == 1 and cell[0].text)
        return [Variable(name, None, texts=texts if len(texts) == len(cells) else ())]
    if kind not in _CLASSES or int(flags[0]) & _COMPLEX:
        return [Variable(name, None)]
    numbers = _numbers(parts[3], order) if len(parts) > 3 else np.empty(0)
    wanted = 1
    for length in shape.tolist():
        wanted *= length
    if wanted != numbers.size:
        raise ValueError(f"variable '{name[:40]}' has {numbers.size} of {wanted} numbers")
    values = numbers.astype(np.dtype(_CLASSES[kind]), casting="unsafe")
    return [Variable(name, values.reshape(shape.tolist(), order="F"))]


def _fields(
    name: str, parts: list[tuple[int, memoryview]], order: str, depth: int, count: int
) -> list[Variable]:
    """Return the fields of structures: all names have one length, the values of each follow."""
    longest = _numbers(parts[3], order)
    text = bytes(parts[4][1])
    size = int(longest[0]) if len(longest) else 0
    if size < 1 or len(text) * count != size * len(parts[5:]):
        raise ValueError(f"the fields of structure '{name[:40]}' are not named")
    variables = []
    wide = len(text) // size
    for number, (kind, data) in enumerate(parts[5:]):
        element, place = divmod(number, wide)
        field = text[place * size : (place + 1) * size].split(b"\0")[0]
        which = f"({element + 1})" if count > 1 else ""
        label = f"{name}{which}.{field.decode('utf-8', errors='replace')}"
        if kind == _MATRIX and len(data):
            variables += _variables(data, order, label, depth + 1)
    return variables


def _letters(part: tuple[int, memoryview], shape: np.ndarray, order: str) -> str:
    """Return a text of one row; of several rows the first."""
    kind, data = part
    encoding = _LETTERS.get(kind, "latin-1")
    if encoding == "utf-16":
        encoding += "-le" if order == "<" else "-be"
    text = bytes(data[: 4 * _LONGEST]).decode(encoding, errors="replace")
    rows = int(shape[0]) if len(shape) else 1
    return text[::rows][:_LONGEST].strip("\0 ") if rows > 1 else text[:_LONGEST].strip("\0 ")


def _numbers(part: tuple[int, memoryview], order: str) -> np.ndarray:
    kind, data = part
    if kind not in _TYPES:
        raise ValueError(f"there is no type of numbers {kind}")
    dtype = np.dtype(order + _TYPES[kind])
    if len(data) % dtype.itemsize:
        raise ValueError(f"{len(data)} bytes are no whole numbers")
    return np.frombuffer(data, dtype)


def variable_names(path: Path) -> set[str]:
    """Names of the variables in a MAT file.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    return {variable.name for variable in read_variables(path)}
