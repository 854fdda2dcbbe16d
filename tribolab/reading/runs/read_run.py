"""Reading of a run: one raw file, two logs, or the files of its cycles."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from tribolab.core.aliases import PathLike
from tribolab.core.errors import ReadError, shown
from tribolab.reading import cures
from tribolab.reading.dialect.find import Dialect, Instrument, is_scan, load_dialect, recognise
from tribolab.reading.raw.source import check_regular, read_unchanged
from tribolab.reading.runs.gather import LogDialects, gather
from tribolab.reading.runs.logs import companion_name, companion_path
from tribolab.reading.runs.row_counts import with_companion_rows
from tribolab.reading.signals import Signals, dataset_of, signals_of
from tribolab.reading.text.first_bytes import peek
from tribolab.units.conversion import positive, to_si

if TYPE_CHECKING:
    import xarray as xr


class Reading(TypedDict, total=False):
    """Options for reading a run besides its files and instrument; see `tribolab.read`."""

    pair: bool
    clock_shift: str | float | None
    zero: str | None
    moving_mass: str | float | None


def read_run(
    path: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    pair: bool = True,
    clock_shift: str | float | None = None,
    zero: str | None = None,
    moving_mass: str | float | None = None,
) -> xr.Dataset:
    """Read one run from its raw file or files; wildcards in names are not expanded.

    Parameters
    ----------
    path, instrument, pair, clock_shift, zero, moving_mass
        As for `tribolab.read`, but without patterns.

    Returns
    -------
    xarray.Dataset
        As for `tribolab.read`.

    Raises
    ------
    ReadError
        If the file cannot be read; the message states the problem, its location and a remedy.
    ConfigError
        If the instrument does not exist.
    """
    paths = [Path(path)] if isinstance(path, str | Path) else [Path(p) for p in path]
    if not paths:
        raise ReadError("no file is given")
    shift = None if clock_shift is None else to_si(clock_shift, "s", "clock_shift")
    if len(paths) == 1 and (own := _own_run(paths[0], instrument)) is not None:
        return own
    dialects = _dialects(paths, instrument)
    main, companions = _split_companions(paths, dialects)
    if pair and len(main) == 1 and not companions:
        companions = _companion(*main[0])
    log = gather(main, zero)
    mass = main[0][1].moving_mass if moving_mass is None else moving_mass
    if len(companions) > 1:
        raise ReadError(f"{companions[0][0]}: more than one companion log is given")
    if companions:
        log = _joined(log, companions, shift)
    elif pair and (expected := companion_name(*main[0])):
        log.attrs["companion_missing"] = expected
    return _without_inertia(dataset_of(log), mass)


def read_log(path: PathLike, instrument: Instrument | None = None) -> Signals:
    """Read one raw file without its companion as arrays; faster than `read_run`.

    Parameters
    ----------
    path, instrument
        As for `read_run`.

    Raises
    ------
    ReadError
        If the file cannot be read; the message states the problem, its location and a remedy.
    ConfigError
        If the instrument does not exist.
    """
    file = Path(path)
    if (own := _own_run(file, instrument)) is not None:
        return signals_of(own)
    (dialect,) = _dialects([file], instrument)
    signals = gather([(file, dialect)])
    if dialect.moving_mass is None:
        return signals
    return signals_of(_without_inertia(dataset_of(signals), dialect.moving_mass))


def with_companion(log: Signals, path: Path, dialect: Dialect) -> Signals:
    """Return a log merged with its second log, whose clock is aligned by the signals.

    Parameters
    ----------
    log
        The main log.
    path
        The second log.
    dialect
        Dialect of the main log, which names that of the second.

    Raises
    ------
    ReadError
        If the second log cannot be read, or does not belong to the run.
    """
    assert dialect.pair is not None  # the caller found the second log by it
    return _joined(log, [(path, load_dialect(dialect.pair.instrument))], None)


def _joined(log: Signals, companions: LogDialects, shift: float | None) -> Signals:
    # imported late for a quick start
    from tribolab.reading.clocks.merge import merge

    motion = read_unchanged([path for path, _ in companions], lambda: gather(companions))
    return with_companion_rows(merge(log, motion, shift), log, motion)


def _without_inertia(run: xr.Dataset, mass: str | float | None) -> xr.Dataset:
    """Subtract the inertial force of a mass, if one is stated."""
    if mass is None:
        return run
    # imported late for a quick start
    from tribolab.reading.runs.inertia import take_inertia

    where = str(run.attrs["source"])
    return take_inertia(
        run, positive(mass, "kg", "moving_mass"), where, moving_mass_source="stated"
    )


def _own_run(path: Path, instrument: Instrument | None) -> xr.Dataset | None:
    """Return the run in a netCDF file; None for any other file."""
    if instrument is not None and load_dialect(instrument).format in ("hdf5", "binary"):
        return None
    if (first := peek(path)).format != "netcdf":
        return None
    # imported late for a quick start
    from tribolab.reading.runs.own_run import read_own_run

    return read_own_run(path, first.path)


def _dialects(paths: list[Path], instrument: Instrument | None) -> list[Dialect]:
    """Return the dialect of each file; companions are recognised by their names."""
    if instrument is None:
        dialects = [recognise(path) for path in paths]
    else:
        dialect = load_dialect(instrument)
        rule = dialect.pair
        dialects = [
            load_dialect(rule.instrument) if rule and path.stem.endswith(rule.other) else dialect
            for path in paths
        ]
    for file, dialect in zip(paths, dialects, strict=True):
        if is_scan(dialect):
            what = f"this looks like a profile ({shown(dialect.title)})"
            raise ReadError(what, where=file, cure=cures.PROFILE)
    return dialects


def _split_companions(
    paths: list[Path], dialects: list[Dialect]
) -> tuple[LogDialects, LogDialects]:
    """Separate main logs from companions."""
    logs = list(zip(paths, dialects, strict=True))
    second = {dialect.pair.instrument for dialect in dialects if dialect.pair}
    main = [log for log in logs if log[1].name not in second]
    companions = [log for log in logs if log[1].name in second]
    names = {dialect.name for _, dialect in main}
    if len(names) > 1:
        raise ReadError(
            f"{paths[0]}: the files of one run come from different instruments: "
            f"{', '.join(sorted(names))}; read them one by one"
        )
    return main, companions


def _companion(path: Path, dialect: Dialect) -> LogDialects:
    """Return the companion log of a file as a list; empty if there is none in the same folder."""
    other = companion_path(path, dialect)
    if other is None or dialect.pair is None or not other.exists():
        return []
    check_regular(other)
    # git-annex and DataLad replace every file of a run by a link
    if other.is_symlink() and not path.is_symlink():
        raise ReadError(
            f"the companion log {shown(other.name)} is a link to {other.resolve()}; tribolab reads "
            "no data from elsewhere unless you name them",
            where=path,
            cure="copy that log next to this one, or name both",
        )
    return [(other, load_dialect(dialect.pair.instrument))]
