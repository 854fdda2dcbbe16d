"""Contents of a raw file: a run, a scan, or the results of a roughness tester."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from tribolab.core.errors import ReadError
from tribolab.reading.dialect.containers import PythonReader, with_columns
from tribolab.reading.dialect.find import is_scan, load_dialect, recognise
from tribolab.reading.netcdf.seal import carries_seal
from tribolab.reading.raw.source import check_regular
from tribolab.reading.scans.formats.named_arrays import is_of_arrays
from tribolab.reading.text.first_bytes import is_results, peek

_LAST_NUMBER = re.compile(r"[ _-]*\d+$")


def kind_of(path: str | Path, instrument: str | Path | None = None) -> str:
    """Return whether a file is a run, a scan or results, from its content or its instrument.

    Parameters
    ----------
    path
        The file.
    instrument
        Its dialect, if known.

    Returns
    -------
    str
        "run", "scan", "results", or "unknown": text or a format without a dialect, perhaps a
        profile that SurfaceTopography reads.

    Raises
    ------
    ConfigError
        If there is no such instrument.
    """
    path = Path(path)
    if instrument is not None:
        dialect = load_dialect(instrument)
        if isinstance(dialect, PythonReader):
            dialect = with_columns(dialect, path)
        return "scan" if is_scan(dialect) else "run"
    try:
        file = peek(path)
    except ReadError:  # missing, empty, or in a format of profilometers
        return "scan" if _is_map(path) else "unknown"
    if file.format != "text" and _is_map(path):
        return "scan"
    if file.format == "netcdf":
        return "run"
    try:
        return "scan" if is_scan(recognise(path)) else "run"
    except ReadError:
        return "results" if is_results(file.head) else "unknown"


def _is_map(path: Path) -> bool:
    """Whether a file of named arrays contains a map, or profiles side by side."""
    try:
        check_regular(path)
        with path.open("rb") as file:
            head = file.read(16)
        if not is_of_arrays(path, head) or carries_seal(path):
            return False
        # imported late for a quick start
        from tribolab.reading.scans.formats.arrays import is_map_file

        return is_map_file(path)
    except (OSError, ValueError, ImportError, ReadError):  # reading it later reports the error
        return False


def repeats_by_name(paths: Iterable[Path]) -> list[list[Path]]:
    """Group scans of one folder whose names differ only in their last number.

    Examples
    --------
    >>> files = [Path("sb-r_1.csv"), Path("smooth_1.csv"), Path("sb-r_2.csv"), Path("a.csv")]
    >>> [[path.name for path in group] for group in repeats_by_name(files)]
    [['sb-r_1.csv', 'sb-r_2.csv'], ['smooth_1.csv'], ['a.csv']]
    """
    groups: dict[object, list[Path]] = {}
    for path in paths:
        name = _LAST_NUMBER.sub("", path.stem)
        alone = not name or name == path.stem
        key: object = path if alone else (path.parent, name, path.suffix)
        groups.setdefault(key, []).append(path)
    return list(groups.values())
