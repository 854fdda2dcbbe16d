"""Writing of simulated runs and scans as raw files: delimited text with fixed decimals."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_lists
from tribolab.studies import xu2026

if TYPE_CHECKING:
    from tribolab.rig.simulated import SimulatedRun

FIRST_DAY = dt.datetime(2026, 3, 2, 9, 12, 31)  # noqa: DTZ001 - instruments have no time zone


def fixed_table(columns: Sequence[tuple[np.ndarray, int]], delimiter: str) -> bytes:
    r"""Return columns of numbers as delimited text with fixed decimals, one row per line.

    Parameters
    ----------
    columns
        Values and number of decimals of each column.
    delimiter
        One character between columns.

    Notes
    -----
    Loggers write fixed decimals, but fast CSV writers only the shortest form (``1e-05``). Here, the
    digits of a column form a matrix of bytes, from which a mask removes leading zeros and absent
    signs. NaN becomes an empty cell.

    Examples
    --------
    >>> fixed_table([(np.array([1.0, -12.345]), 2), (np.array([0.5, 0.0]), 1)], ",")
    b'1.00,0.5\n-12.34,0.0\n'
    """
    blocks, masks = [], []
    for number, (values, decimals) in enumerate(columns):
        known = np.isfinite(values)[:, None]
        scaled = np.where(known[:, 0], np.asarray(values) * 10**decimals, 0.0)
        counts = np.rint(scaled).astype(np.int64)
        size = np.abs(counts)
        width = max(len(str(int(size.max(initial=0)))), decimals + 1)
        digits = np.empty((counts.size, width), dtype=np.uint8)
        rest = size.astype(np.uint32) if int(size.max(initial=0)) < 2**32 else size
        for place in range(width - 1, -1, -1):
            rest, digit = np.divmod(rest, rest.dtype.type(10))
            digits[:, place] = digit
        digits += ord("0")
        shown = size[:, None] >= 10 ** np.arange(width - 1, -1, -1, dtype=np.int64)
        shown[:, width - 1 - decimals :] = True
        always = np.ones((counts.size, 1), dtype=bool)
        end = ord("\n" if number == len(columns) - 1 else delimiter)
        whole = width - decimals
        point = np.full((counts.size, 1), ord("."), dtype=np.uint8)
        sign = np.full((counts.size, 1), ord("-"), dtype=np.uint8)
        close = np.full((counts.size, 1), end, dtype=np.uint8)
        blocks += [sign, digits[:, :whole], point, digits[:, whole:], close]
        masks += [counts[:, None] < 0, shown[:, :whole] & known, known & (decimals > 0)]
        masks += [shown[:, whole:] & known, always]
    return np.concatenate(blocks, axis=1)[np.concatenate(masks, axis=1)].tobytes()


def force_file(log: xr.Dataset, date: dt.datetime) -> bytes:
    """Return the content of the file of a force log, as the data logger writes it."""
    head = (
        "# Linear slider, force log\n"
        f"# date: {date.isoformat()}\n"
        "# sensor: two-axis force cell, +-500 N, 16 bit\n"
        "# rate: set by the step\n"
        "Time [s],Fx [N],Fz [N]\n"
    )
    columns = [(log.time.values, 5), (log.friction_force.values, 3), (log.normal_force.values, 3)]
    return head.encode() + fixed_table(columns, ",")


def motion_file(log: xr.Dataset, date: dt.datetime) -> bytes:
    """Return the content of the file of a motion log, as the table's controller writes it."""
    head = (
        "# Linear slider, motion log\n"
        f"# date: {date.isoformat()}\n"
        "# encoder: linear, 0.1 um\n"
        "# rate: set by the step\n"
        "Time [s];Position [mm];Velocity [mm/s];Set speed [mm/s]\n"
    )
    columns = [
        (log.time.values, 5),
        (log.position.values * 1e3, 4),
        (log.sliding_velocity.values * 1e3, 6),
        (log.set_speed.values * 1e3, 5),
    ]
    return head.encode() + fixed_table(columns, ";")


@of_lists("run")
def write_run(
    run: SimulatedRun, folder: str | Path = ".", date: dt.datetime = FIRST_DAY
) -> tuple[Path, Path]:
    """Write the force log and the motion log of a simulated run.

    Parameters
    ----------
    run
        From `simulate_run`; a list of runs gives a list.
    folder
        Target folder, created if missing.
    date
        Start of the run, for the file headers.

    Returns
    -------
    tuple of pathlib.Path
        Files of the force log, which `tribolab.read` reads, and of the motion log next to it.

    Examples
    --------
    >>> import tempfile
    >>> from tribolab import rig
    >>> short = rig.Rig(rig.Protocol(speeds=(1e-4,)))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [file.name for file in write_run(rig.simulate_run("Sb-R", "dry", rig=short), folder)]
    ['sb-r_dry_31N_01_force.csv', 'sb-r_dry_31N_01_motion.csv']
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    force, motion = (folder / f"{run.name}_{log}.csv" for log in ("force", "motion"))
    force.write_bytes(force_file(run.force_log, date))
    motion.write_bytes(motion_file(run.motion_log, date))
    return force, motion


def scan_file(
    x: np.ndarray,
    height: np.ndarray,
    *,
    tip_radius: float = xu2026.profilometer.tip_radius,
    pitch: float | None = None,
    length: float | None = None,
    results: Mapping[str, float] | None = None,
) -> bytes:
    """Return the content of the file of a profile, as the stylus instrument exports it.

    All arguments are in m. `pitch` and `length` are those stated in the header, by default the true
    ones; `results` are Ra and Rq computed by the instrument, exported only if given.
    """
    pitch = x[1] - x[0] if pitch is None else pitch
    length = x[-1] - x[0] if length is None else length
    head = (
        "# Surftest profile\n"
        f"# tip radius: {tip_radius * 1e6:g} um\n"
        f"# pitch: {pitch * 1e6:g} um\n"
        f"# length: {length * 1e3:g} mm\n"
        + "".join(f"# {name}: {1e6 * value:.7f} um\n" for name, value in (results or {}).items())
        + "x [mm],z [um]\n"
    )
    return head.encode() + fixed_table([(x * 1e3, 4), (height * 1e6, 3)], ",")


def write_scans(scans: xr.Dataset, folder: str | Path = ".", surface: str = "") -> list[Path]:
    """Write each simulated scan into a file, as the stylus instrument exports it.

    Parameters
    ----------
    scans
        ``height`` [m] (profile, x), from `tribolab.rig.scans`.
    folder
        Target folder, created if missing.
    surface
        First part of the file names; by default the name of the surface.

    Examples
    --------
    >>> import tempfile
    >>> from tribolab import rig
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [file.name for file in write_scans(rig.scans("Sb-R", 2, length=1e-3), folder)]
    ['sb-r_1.csv', 'sb-r_2.csv']
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    stem = surface or str(scans.attrs["surface"]).lower()
    files = []
    for number, height in enumerate(scans["height"].values, start=1):
        files.append(folder / f"{stem}_{number}.csv")
        files[-1].write_bytes(scan_file(scans["x"].values, height))
    return files
