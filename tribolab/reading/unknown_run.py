"""Reading of runs of any instrument; for an unknown one, a dialect is drafted from the file.

`tribolab.reading.runs.read_run` reads the runs of known instruments only.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, Unpack

from tribolab.core.aliases import PathLike
from tribolab.core.errors import LacksError, NoNumbersError, ReadError, shown
from tribolab.reading import cures
from tribolab.reading.dialect.find import Dialect, Instrument, UnknownFileError, recognise
from tribolab.reading.raw.opening import CrashedError, RefusedError
from tribolab.reading.raw.source import read_unchanged
from tribolab.reading.runs import read_run as runs
from tribolab.reading.signals import Signals
from tribolab.reading.text.cells import split_name
from tribolab.reading.text.first_bytes import peek
from tribolab.reading.unit_texts import converts, measures_something

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.reading.unknown.proposal.draft import Draft

DRAFTED = "drafted from the file"


class _Described(Protocol):
    """Any form of a run: a dataset or signals, with attributes."""

    @property
    def attrs(self) -> dict[Any, Any]: ...


_Run = TypeVar("_Run", bound=_Described)
_Reader = Callable[[Instrument | None, bool], _Run]


def read_run(
    path: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    **options: Unpack[runs.Reading],
) -> xr.Dataset:
    """Read one run, with a dialect drafted from the file if no known dialect fits.

    Parameters
    ----------
    path, instrument, **options
        As for `tribolab.reading.runs.read_run.read_run`.

    Returns
    -------
    xarray.Dataset
        As from `tribolab.read`. Attributes of a drafted description: ``instrument`` states that
        it is drafted, ``to_keep_it`` how to store it, ``without_unit`` lists lines that are not
        used as they lack a unit, ``left_out`` doubtful columns that are not needed, and
        ``drafted_layout`` is a checksum that files of one layout share.

    Raises
    ------
    ReadError
        If the file cannot be read. If its header states too little, the message lists guesses.
    ConfigError
        If there is no such instrument.
    """
    paths = [Path(path)] if isinstance(path, PathLike) else [Path(name) for name in path]

    def read(dialect: Instrument | None, drafted: bool) -> xr.Dataset:
        how: runs.Reading = {**options, "pair": False} if drafted else options
        return runs.read_run(path, dialect, **how)

    return read_unchanged(paths, lambda: _by_any(paths, instrument, read))


def read_log(
    path: PathLike, instrument: Instrument | None = None, excerpt: Path | None = None
) -> Signals:
    """Read one raw file as arrays, without its companion log.

    With an excerpt, the dialect is found from the whole file, and the excerpt is read.
    """
    file = Path(path)
    source = excerpt or file

    def read(dialect: Instrument | None, _: bool) -> Signals:
        return runs.read_log(source, dialect or (recognise(file) if excerpt else None))

    return read_unchanged([source], lambda: _by_any([file], instrument, read))


def _by_any(paths: list[Path], instrument: Instrument | None, read: _Reader[_Run]) -> _Run:
    """Read a run with the known dialect, else with one that is drafted from its first file."""
    attrs: dict[str, str] = {}
    try:
        return read(instrument, False)
    except UnknownFileError as error:
        if Path(error.where) != paths[0]:
            raise  # the unknown file is not the first one
        dialect = _drafted(paths[0], error)
    except LacksError as error:
        other = None if instrument is not None or len(paths) > 1 else _complete_dialect(paths[0])
        if other is None:
            raise
        dialect, attrs = other, {"known_layout_lacks": str(error.what)}
    run = read(dialect, True)
    run.attrs.update(_guess_attrs(paths[0]) | attrs)
    return run


def is_run_file(path: Path, *, by_name: bool = True) -> bool:
    """Whether a file of an unknown instrument contains a run; `by_name`: by its column names."""
    draft = draft_of(path)
    if draft is None:
        return _has_signals(path)
    in_columns = draft.layout is not None and draft.layout.held is not None  # with names
    return draft.kind == "run" and (draft.named or not by_name or in_columns)


def _has_signals(path: Path) -> bool:
    """Whether a file has a format of recorded signals: TDMS, Parquet or Feather."""
    try:
        return peek(path).format in ("tdms", "parquet", "feather")
    except ReadError:
        return False


def _drafted(path: Path, error: UnknownFileError) -> Dialect:
    """Return the dialect drafted from a file; raise an error if it leaves questions open."""
    # imported late for a quick start
    from tribolab.reading.moduli import is_modulus_file
    from tribolab.reading.unknown.proposal.answers import leave_out_doubtful

    if is_modulus_file(path):
        what = "a table of a modulus over frequency: no friction is in it"
        raise ReadError(what, where=path, cure=cures.MODULUS) from error
    try:
        draft = _drafted_once(path)
    except (RefusedError, CrashedError, NoNumbersError):
        raise
    except (ReadError, OSError, ImportError) as reason:
        if peek(path).format != "text" or not isinstance(reason, ReadError):
            raise error from reason
        cause = str(reason.what).removeprefix(f"{path}: ")
        raise UnknownFileError(f"{error.what}: {cause}", where=path, cure=error.cure) from reason
    if (gap := left_open(draft)) is not None:
        raise gap from error
    if draft.kind == "table" and draft.labels:
        error_type = ReadError if measures_other_things(draft) else UnknownFileError
        raise error_type(draft.answer, where=path) from error
    if draft.kind == "table" and draft.guesses:
        what = f"none of its columns has a name; {draft.guesses[0]}"
        cure = "write names and units above the numbers, e.g. f [Hz], G' [Pa], G'' [Pa]"
        raise ReadError(what, where=path, cure=cure) from error
    if draft.kind == "table" or (draft.kind == "scan" and peek(path).format != "text"):
        raise error
    if draft.kind == "scan":
        what = "no known instrument writes such a file; it looks like a profile or map"
        raise ReadError(what, where=path, cure=cures.PROFILE) from error
    draft, _ = leave_out_doubtful(draft)
    assert draft.dialect is not None  # only tables have none
    return draft.dialect


def left_open(draft: Draft) -> ReadError | None:
    """Return an error with the open questions about a run or profile; None if there are none."""
    # imported late for a quick start
    from tribolab.reading.unknown.proposal.answers import leave_out_doubtful
    from tribolab.reading.unknown.proposal.questions import (
        GuessedError,
        lacks_friction,
        missing_options,
        missing_words,
        questions,
        understood_columns,
    )

    if draft.unsaid:
        known = understood_columns(draft) or [f"height '{shown(draft.labels[0], 20)}'"]
        return GuessedError(draft.path, [], cures.SURFACE, [draft.answer], known)
    if draft.kind == "table":
        return None
    draft, _ = leave_out_doubtful(draft)
    asked, known = questions(draft), understood_columns(draft)
    if asked or lacks_friction(draft):
        lacks, options = missing_words(draft), missing_options(draft, asked)
        by_option = missing_words(draft, by_option=True)
        return GuessedError(draft.path, asked, cures.RUN, lacks, known, options, by_option)
    return None


def measures_other_things(draft: Draft) -> bool:
    """Whether most columns of a table have units, but none a unit of length: kg, deg, N."""
    columns = draft.understood.columns if draft.understood is not None else ()
    units = [column.file_unit or split_name(column.label)[1] or "" for column in columns]
    stated = [unit for unit in units if measures_something(unit)]
    return len(stated) > len(units) / 2 and not any(converts(unit, "m") for unit in stated)


def _complete_dialect(path: Path) -> Dialect | None:
    """Return the dialect drafted from a file if it leaves no question open, else None."""
    # imported late for a quick start
    from tribolab.reading.unknown.proposal.questions import missing_words, questions

    draft = draft_of(path)
    if draft is None or draft.kind != "run" or questions(draft) or missing_words(draft):
        return None
    return draft.dialect


def draft_of(path: Path) -> Draft | None:
    """Return the draft of a dialect for a file; None if it cannot be drafted."""
    try:
        return _drafted_once(path)
    except (ReadError, OSError, ImportError):  # `_drafted` reports why
        return None


def _drafted_once(path: Path) -> Draft:
    status = path.stat()
    drafted = _draft_as_it_was(path, status.st_size, status.st_mtime_ns)
    if isinstance(drafted, ReadError):
        raise drafted.with_traceback(None)
    return drafted


@functools.lru_cache(maxsize=1)  # the same file is drafted to find its kind, and then to read it
def _draft_as_it_was(path: Path, size: int, changed: int) -> Draft | ReadError:
    # imported late for a quick start
    from tribolab.reading.unknown.proposal.draft import draft_dialect

    try:
        return draft_dialect(path)
    except ReadError as error:  # cached, as drafting again would take as long
        return error


def _guess_attrs(path: Path) -> dict[str, str]:
    # imported late for a quick start
    from tribolab.reading.unknown.proposal.answers import leave_out_doubtful
    from tribolab.reading.unknown.proposal.questions import how_to_keep, without_unit_and_missed

    attrs = {"instrument": DRAFTED, "to_keep_it": how_to_keep(path)}
    draft = draft_of(path)
    if draft is None:
        return attrs
    draft, left = leave_out_doubtful(draft)
    attrs |= {"left_out": "; ".join(left)} if left else {}
    missed = without_unit_and_missed(draft)
    attrs |= {"without_unit": "; ".join(missed)} if missed else {}
    return {**attrs, "drafted_layout": _checksum(draft)}


def _checksum(draft: Draft) -> str:
    """Return a checksum of the dialect without its name, equal for files of one layout."""
    text = "" if draft.dialect is None else draft.dialect.model_dump_json(exclude={"name", "title"})
    return hashlib.sha256(text.encode()).hexdigest()[:16]
