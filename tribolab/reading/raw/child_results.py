"""Transfer of results from a child process: numbers, texts, arrays and errors, but no code."""

from __future__ import annotations

import io
import mmap
import os
import pickle
from typing import Any, NamedTuple

from tribolab.arrays.scratch import take_in

LENGTH = 8  # bytes of a message length
_MAPPED = 1 << 20  # bytes above which a result is mapped from its file, not copied
_ALIGNED = 64
_FUNCTIONS = {  # functions that rebuild arrays and datasets; all other globals are classes
    ("numpy", "_frombuffer"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy.core.multiarray", "scalar"),
    ("pandas._libs.internals", "_unpickle_block"),
    ("pandas.core.indexes.base", "_new_Index"),
    ("pyarrow.lib", "_restore_array"),  # columns of text in pandas
    ("pyarrow.lib", "py_buffer"),
    ("pyarrow.lib", "type_for_alias"),
    ("copyreg", "__newobj__"),
    ("copyreg", "_reconstructor"),
}
_ROOMS = ("builtins", "numpy", "pandas", "xarray", "datetime", "collections", "pathlib", "tribolab")


class Failure(NamedTuple):
    """Class, arguments and state of an error, for transfer between processes."""

    kind: type[Exception]
    arguments: tuple[Any, ...]
    state: dict[str, Any]


def packed_error(error: object) -> Any:
    """Return an error as `Failure`, including errors nested in it; anything else is unchanged."""
    if not isinstance(error, Exception):
        return error
    state = {key: packed_error(value) for key, value in vars(error).items() if key[0] != "_"}
    return Failure(type(error), tuple(map(packed_error, error.args)), state)


def unpacked_error(failure: Any) -> Any:
    """Return the error packed by `packed_error`; anything else unchanged."""
    if not isinstance(failure, Failure):
        return failure
    error = failure.kind.__new__(failure.kind, *map(unpacked_error, failure.arguments))
    error.args = tuple(map(unpacked_error, failure.arguments))
    for key, value in failure.state.items():
        setattr(error, key, unpacked_error(value))
    return error


def write_result(value: object, file: io.BufferedIOBase, most: int) -> bool:
    """Write a result so that long arrays can be read without copying.

    Parameters
    ----------
    value
        Anything that can be pickled.
    file
        File open for writing, at its start.
    most
        Limit on the size of all arrays [bytes].

    Returns
    -------
    bool
        True if the result was written, False if its arrays exceed the limit.
    """
    buffers: list[pickle.PickleBuffer] = []
    data = pickle.dumps(value, protocol=5, buffer_callback=buffers.append)
    raw = [buffer.raw() for buffer in buffers]
    if sum(part.nbytes for part in raw) > most:
        return False
    head = pickle.dumps((len(data), [part.nbytes for part in raw]))
    file.write(len(head).to_bytes(LENGTH, "little") + head + data)
    for part in raw:
        file.write(b"\0" * (-file.tell() % _ALIGNED))
        file.write(part)
    return True


def read_result(handle: int) -> Any:
    """Read a result written by `write_result`."""
    with open(handle, "r+b", closefd=False) as file:  # noqa: PTH123 - a descriptor
        if os.fstat(handle).st_size > _MAPPED:
            content: Any = mmap.mmap(handle, 0)
            take_in(content)
        else:
            content = bytearray(file.read())
    view = memoryview(content)
    first = LENGTH + int.from_bytes(view[:LENGTH], "little")
    size, lengths = pickle.loads(view[LENGTH:first])
    place = first + size
    buffers = []
    for length in lengths:
        place += -place % _ALIGNED
        buffers.append(view[place : place + length])
        place += length
    return _SafeUnpickler(io.BytesIO(view[first : first + size]), buffers=buffers).load()


class _SafeUnpickler(pickle.Unpickler):
    """Unpickler that accepts numbers, texts, arrays and records, and only known functions."""

    def find_class(self, module: str, name: str) -> Any:
        found = None
        if (module, name) in _FUNCTIONS or module.split(".")[0] in _ROOMS:
            found = super().find_class(module, name)
        if (module, name) in _FUNCTIONS or isinstance(found, type):
            return found
        raise pickle.UnpicklingError(f"{module}.{name} is no result of reading a file")
