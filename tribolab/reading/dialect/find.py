"""Dialects: TOML descriptions of instruments' raw files, found by name or by content."""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tribolab.core.errors import ConfigError, ReadError, TribolabError, brief, nearest, shown
from tribolab.core.untyped import Json
from tribolab.reading import cures
from tribolab.reading.dialect.model import Dialect as Dialect
from tribolab.reading.raw.readers import installed_readers, is_reader
from tribolab.reading.raw.source import Identity, check_regular, identity_of
from tribolab.reading.schema_folder import schema_folder
from tribolab.reading.text.first_bytes import File, peek, results_error

Instrument = str | Path | Dialect  # a name, a TOML file, or a dialect
_SHOWN = 5  # most errors of a dialect reported at once


class UnknownFileError(ReadError):
    """Raised if no dialect describes a file; one may be drafted from it."""


def known_dialects() -> dict[str, Path]:
    """Return the TOML file of each known instrument, by name.

    Examples
    --------
    >>> "linear_slider" in known_dialects()
    True
    """
    return {path.stem: path for path in sorted((schema_folder() / "instruments").glob("*.toml"))}


def load_dialect(name_or_path: Instrument) -> Dialect:
    """Return the dialect of a known instrument, or of a TOML file of your own.

    Parameters
    ----------
    name_or_path
        Name of a known instrument or of an installed reader, path of a TOML file or of a reader in
        Python, or a dialect, which is returned as it is.

    Raises
    ------
    ConfigError
        If the dialect does not exist, or is invalid.

    Examples
    --------
    >>> load_dialect("linear_slider").text.delimiter
    ','
    """
    if isinstance(name_or_path, Dialect):
        return name_or_path
    known = known_dialects()
    if str(name_or_path) in known:
        return _load(known[str(name_or_path)])
    if is_reader(str(name_or_path)):
        # imported late for a quick start
        from tribolab.reading.dialect.containers import python_reader

        return python_reader(str(name_or_path))
    path = Path(name_or_path)
    if path.suffix == ".toml":
        if not path.exists():
            raise ConfigError(f"{path}: there is no such dialect file")
        try:
            check_regular(path)
        except ReadError as error:
            raise ConfigError(error) from error
        return _parse(path)
    raise ConfigError(
        f"no instrument is called '{shown(str(name_or_path))}'{nearest(str(name_or_path), known)}; "
        "a description of your own is given by its path, ending in .toml, a reader by .py"
    )


def recognise(path: str | Path) -> Dialect:
    """Recognise the instrument that wrote a file from its content, and return its dialect.

    Raises
    ------
    ReadError
        If no dialect or more than one fits; the message names the candidates and how to choose.
    """
    file = peek(path)
    named = file._replace(path=Path(path))  # the unpacked file has another path
    state = identity_of(file.path)
    find = _matching_dialects.__wrapped__ if state is None else _matching_dialects
    fitting = find(file, state, tuple(known_dialects().values()))
    if not fitting and installed_readers():
        # imported late: rarely needed
        from tribolab.reading.dialect.containers import recognised_by

        fitting = recognised_by(file.head)
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        names = ", ".join(repr(dialect.name) for dialect in fitting)
        raise ReadError(
            f"more than one instrument fits: {names}",
            where=named.path,
            cure=cures.name_instrument(cures.RUN),
        )
    if error := results_error(file.head, named.path):
        raise error
    raise unknown(named, cures.RUN)


@functools.lru_cache(maxsize=4)  # requested several times per reading
def _matching_dialects(file: File, _: Identity | None, known: tuple[Path, ...]) -> list[Dialect]:
    """Return the dialects that match a file."""
    # imported late for a quick start
    from tribolab.reading.dialect.recognise import mismatch

    return [dialect for dialect in map(_load, known) if mismatch(file, dialect) is None]


def unknown(file: File, table: str) -> UnknownFileError:
    """Return the error for a file that matches no dialect."""
    what = f"no known instrument writes such a file ({file.format})"
    if file.format != "text":
        folder = "describe it as raw_data_schema/README.md says"
        cure = cures.name_instrument(table, say=f"{folder}, and name that with")
        if file.format == "excel":
            cure = cures.joined(cures.PERHAPS_PROFILE, cure)
        return UnknownFileError(what, where=file.path, cure=cure)
    return UnknownFileError(what, where=file.path, cure=cures.unknown_instrument(file.path, table))


def is_scan(dialect: Dialect) -> bool:
    """Whether a dialect's files contain a profile or map instead of a run.

    Examples
    --------
    >>> is_scan(load_dialect("surftest_csv")), is_scan(load_dialect("linear_slider"))
    (True, False)
    """
    keys = {column.key for column in dialect.column}
    return "height" in keys and "time" not in keys


def every_dialect() -> list[Dialect]:
    """Return the dialects of all known instruments, by name."""
    return [_load(path) for path in known_dialects().values()]


def json_schema() -> Json:
    """Return the JSON Schema of a dialect file, for editors and other programs."""
    schema = Dialect.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


@functools.lru_cache(maxsize=64)
def _load(path: Path) -> Dialect:
    return _parse(path)


def _parse(path: Path) -> Dialect:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except RecursionError as error:
        raise ConfigError(
            f"{path}: the dialect cannot be read: its lists or tables lie hundreds deep in one "
            "another; write them flat"
        ) from error
    except (OSError, ValueError) as error:
        raise ConfigError(f"{path}: the dialect cannot be read: {brief(error)}") from error
    try:
        return Dialect.model_validate(content)
    except ValidationError as error:
        said = [_explain(fault) for fault in error.errors()]
        more = [f"and {len(said) - _SHOWN} more"] if len(said) > _SHOWN else []
        raise ConfigError("; ".join(said[:_SHOWN] + more), where=path) from error
    except TribolabError as error:  # error of a unit or number, which names its key
        raise ConfigError(error, where=path) from error


def _explain(problem: Any) -> str:
    where = ".".join(shown(str(part)) for part in problem["loc"])
    if problem["type"] != "extra_forbidden":
        return f"{where}: {problem['msg'].removeprefix('Value error, ')}".removeprefix(": ")
    model = _model_at(problem["loc"][:-1])
    word = str(problem["loc"][-1])
    return f"{where}: there is no such key{nearest(word, model)}"


def _model_at(loc: tuple[str | int, ...]) -> list[str]:
    """Return the keys that are allowed at a location in a dialect."""
    # imported late for a quick start
    from tribolab.reading.dialect import model as dialect_model

    name = next((str(part) for part in reversed(loc) if isinstance(part, str)), "dialect")
    return list(getattr(dialect_model, name.capitalize()).model_fields)
