"""Reading of one run, or of all runs in a folder or pattern."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, overload

import xarray as xr

from tribolab.core.aliases import PathLike
from tribolab.reading.dialect.find import Instrument
from tribolab.reading.file_patterns import is_pattern, matching
from tribolab.reading.folder_content import files_with
from tribolab.reading.runs.logs import group_files
from tribolab.reading.runs.read_run import Reading
from tribolab.reading.unknown_run import read_run


@overload
def read(
    path: PathLike,
    instrument: Instrument | None = None,
    *,
    pair: bool = True,
    clock_shift: str | float | None = None,
    zero: str | None = None,
    moving_mass: str | float | None = None,
) -> Any: ...  # one run, or a list: a type checker cannot tell patterns from names


@overload
def read(
    path: Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    pair: bool = True,
    clock_shift: str | float | None = None,
    zero: str | None = None,
    moving_mass: str | float | None = None,
) -> xr.Dataset: ...


def read(
    path: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    pair: bool = True,
    clock_shift: str | float | None = None,
    zero: str | None = None,
    moving_mass: str | float | None = None,
) -> xr.Dataset | list[xr.Dataset]:
    r"""Read one run from its raw file or files, or all runs of a folder or pattern.

    Parameters
    ----------
    path
        A raw file: text (csv, txt, dat, asc, with any separator), Excel (xlsx, xls, ods), HDF5,
        MAT, TDMS, Parquet, Feather, JSON, NumPy (npz), or netCDF; a pattern such as
        ``"raw/*.csv"`` (``**`` includes subfolders), or a folder, for the runs among its files
        (`read_scans` reads the scans); or a list: the two logs of a run, or the
        files of consecutive cycles, in any order if they state when they start.
    instrument
        Name of a known instrument, path of a TOML description of your own, or a dialect such as
        ``tl.reading.draft_dialect(path).dialect``. By default the instrument is recognised from the
        file's content. A file of an unknown instrument is read if its header names every column;
        the attribute ``instrument`` is then "drafted from the file".
    pair
        Also read the companion log in the same folder, if the instrument writes one.
    clock_shift
        Time to add to the companion's clock to obtain this log's clock [s]; by default estimated
        from the signals.
    zero
        Part of the record that gives the zero of the friction signal: ``"first 200 samples"``,
        ``"first 2 s"``, ``"1.5 s to 3 s"``, or ``"file blank.csv"``, a run without contact in the
        same folder.
    moving_mass
        Mass between the contact and the force sensor ("1.2 kg", or a number in kg). Its inertia is
        subtracted from the friction force and is the variable ``inertial_force``. An unknown mass
        can be estimated by `without_inertia`.

    Returns
    -------
    xarray.Dataset or list of xarray.Dataset
        Dim ``time`` [s] from the first sample, strictly increasing; the recorded quantities, in
        SI; settings outside the table as attributes, with the unit in the name. Raw time is
        ``time + time_origin_s``. For a folder or pattern a list with each run once, in order of
        name: a log and its companion are one run.

    Raises
    ------
    ReadError
        If a file cannot be read, or no file matches the pattern; the message states what is
        wrong, where, and how to fix it. For a file of an unknown instrument it states what is
        uncertain, with the alternatives.
    ConfigError
        If there is no such instrument.

    Notes
    -----
    Time must increase strictly; `clocks.clock` describes how other clocks are treated. Missing
    values are NaN, as are numbers beyond 1e100, which ``numbers_beyond_range`` counts. An optional
    column without values is omitted and named in ``columns_not_used``.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> head = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n"
    >>> for number in (1, 2):
    ...     file = folder / f"sb-r_dry_31N_0{number}_force.csv"
    ...     _ = file.write_text(head + f"5.0,{number}.0,31.0\n5.1,2.0,31.0\n")
    >>> run = read(file)
    >>> run.friction_force.values.tolist(), run.attrs["time_origin_s"]
    ([2.0, 2.0], 5.0)
    >>> [run.attrs["source"] for run in read(folder / "*_force.csv")]
    ['sb-r_dry_31N_01_force.csv', 'sb-r_dry_31N_02_force.csv']
    """
    options: Reading = {"pair": pair, "clock_shift": clock_shift, "zero": zero}
    options["moving_mass"] = moving_mass
    if not isinstance(path, PathLike) or not (is_pattern(path) or Path(path).is_dir()):
        return read_run(path, instrument, **options)
    files = files_with("run", path) if instrument is None else matching(path)
    runs = group_files(files, instrument) if pair else [[file] for file in files]
    return [read_run(logs, instrument, **options) for logs in runs]
