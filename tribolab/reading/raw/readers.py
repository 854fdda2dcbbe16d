"""Custom readers in Python: a local file or an installed package.

A reader has two functions. ``can_read(head)`` answers "yes", "maybe" or "no" to the first bytes of
a file; ``read(path)`` returns a `RawFile` or an `xarray.Dataset` whose columns are named after
tribolab's quantities, each with its unit. A package registers its module under the entry point
group ``tribolab.readers``.
"""

from __future__ import annotations

import functools
import importlib.util
import traceback
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from tribolab.core.errors import ConfigError, ReadError, TribolabError, shown
from tribolab.reading.raw.containers.groups import settings_of
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable
from tribolab.reading.raw.source import check_regular
from tribolab.units.quantities import QUANTITIES

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    import xarray as xr

GROUP = "tribolab.readers"
Answer = Literal["yes", "maybe", "no"]
_HEAD = 1 << 16  # bytes passed to `can_read`


class Reader(NamedTuple):
    """Reader with its name and two functions."""

    name: str
    can_read: Callable[[bytes], Answer]
    read: Callable[[Path], RawFile | xr.Dataset]


def is_reader(name: str) -> bool:
    """Whether an instrument is a Python file or an installed reader."""
    return name.endswith(".py") or (not name.endswith(".toml") and name in installed_readers())


@functools.lru_cache(maxsize=1)
def installed_readers() -> dict[str, EntryPoint]:
    """Return the readers of installed packages by name."""
    # imported late: loads slowly
    from importlib.metadata import entry_points

    return {point.name: point for point in entry_points(group=GROUP)}


def source_of(name: str) -> Path:
    """Return the Python file of a reader.

    Raises
    ------
    ConfigError
        If the file does not exist.
    """
    if name in installed_readers():
        found = importlib.util.find_spec(installed_readers()[name].module)
        return Path(found.origin if found is not None and found.origin else name)
    path = Path(name)
    if not path.exists():
        raise ConfigError(f"{path}: there is no such reader")
    try:
        check_regular(path)
    except ReadError as error:
        raise ConfigError(error) from error
    return path


def answers(head: bytes) -> dict[str, Answer]:
    """Return the answers of installed readers to the first bytes of a file, except "no"."""
    answers = {name: _answer(_loaded(name), head) for name in installed_readers()}
    return {name: answer for name, answer in answers.items() if answer != "no"}


def read_with(name: str, path: Path) -> RawFile:
    """Read a file with a reader.

    Parameters
    ----------
    name
        Path of a Python file, or the name of an installed reader.
    path
        The file.

    Raises
    ------
    ConfigError
        If the reader cannot be imported, or lacks a function.
    ReadError
        If it cannot read the file, fails, or returns no columns with units.
    """
    state = path.stat()
    return _read(name, _stamp(name), path, state.st_size, state.st_mtime_ns)


@functools.lru_cache(maxsize=2)  # a file is read twice: for its columns, and for its numbers
def _read(name: str, stamp: int, path: Path, size: int, changed: int) -> RawFile:
    reader = _loaded(name)
    with path.open("rb") as file:
        if _answer(reader, file.read(_HEAD)) == "no":
            raise ReadError(f"{reader.name} does not read such a file (can_read: no)", where=path)
    try:
        result = reader.read(path)
    except TribolabError:
        raise
    except Exception as error:  # foreign code may raise anything
        raise ReadError(f"{reader.name} fails: {_error_text(error)}", where=path) from error
    if isinstance(result, RawFile):
        raw = result._replace(path=path)
    elif hasattr(result, "data_vars"):
        raw = _of_dataset(path, result)
    else:
        kind = type(result).__name__
        what = f"{reader.name} returns a {shown(kind)}; return a RawFile or an xarray.Dataset"
        raise ReadError(what, where=path)
    for table in raw.tables:
        for column in table.columns:
            known = QUANTITIES.get(column.label)
            if column.unit is None and known is not None and known.unit != "1":
                what = f"{reader.name} states no unit of '{column.label}', e.g. '{known.unit}'"
                raise ReadError(what, where=path)
    return raw


def _of_dataset(path: Path, data: xr.Dataset) -> RawFile:
    """Convert a reader's dataset: variables along time, or heights and positions of a scan."""
    heights = data["height"] if "height" in data and "time" not in data.dims else None
    if heights is not None:
        names = [str(name) for name in (*heights.dims, "height") if name in data.variables]
        values = [data[name].broadcast_like(heights).transpose(*heights.dims) for name in names]
    else:
        names = [str(name) for name in data.variables if data[name].dims == ("time",)]
        values = [data[name] for name in names]
    units = [data[name].attrs.get("units") for name in names]
    columns = tuple(
        RawColumn(name, None if unit is None else str(unit), part.values.ravel())
        for name, unit, part in zip(names, units, values, strict=True)
    )
    settings = [s for key, value in data.attrs.items() for s in settings_of(str(key), value)]
    return RawFile(path, "python", (RawTable("", columns),), tuple(settings))


def _stamp(name: str) -> int:
    return source_of(name).stat().st_mtime_ns


def _loaded(name: str) -> Reader:
    return _load(name, _stamp(name))


@functools.lru_cache(maxsize=16)
def _load(name: str, stamp: int) -> Reader:
    path = source_of(name)
    try:
        own = installed_readers().get(name)
        module: Any = _run(path) if own is None else own.load()
        return Reader(path.name, module.can_read, module.read)
    except AttributeError as error:
        what = f"{path}: a reader has the functions can_read(head) and read(path); {error}"
        raise ConfigError(what) from error
    except Exception as error:  # foreign code may raise anything
        raise ConfigError(f"{path}: cannot be imported: {_error_text(error)}") from error


def _run(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"tribolab_reader_{path.stem}", path)
    assert spec is not None and spec.loader is not None  # its name ends in .py
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _answer(reader: Reader, head: bytes) -> Answer:
    try:
        answer = reader.can_read(head)
    except Exception as error:  # foreign code may raise anything
        raise ConfigError(f"{reader.name}: can_read fails: {_error_text(error)}") from error
    if answer not in ("yes", "maybe", "no"):
        what = f"{reader.name}: can_read returns {shown(repr(answer), 40)}"
        raise ConfigError(f"{what}; return 'yes', 'maybe' or 'no'")
    return answer


def _error_text(error: Exception) -> str:
    """Return an error message with the line of the reader that raised it."""
    frames = traceback.extract_tb(error.__traceback__)
    last = next((frame for frame in reversed(frames) if frame.filename != __file__), None)
    where = f" ({Path(last.filename).name}, line {last.lineno})" if last else ""
    return shown(f"{type(error).__name__}: {error}", 160) + where
