"""The work on one run and on one curve, as a worker process does it.

A worker reads raw files, writes its result itself and hands back a small record: nothing that is
as large as a signal travels between processes.
"""

from __future__ import annotations

import errno
import math
import shutil
import threading
import time
import traceback
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.campaign.outcome import CurveOutcome, RunOutcome
from tribolab.campaign.plan import PlannedRun
from tribolab.campaign.zeros import RunZero, attributes, zero_of
from tribolab.errors import ConfigError, OutputError, TribolabError, brief, shown
from tribolab.provenance import as_text, made, sha256_of, sha256_of_file
from tribolab.quantities import stamp

if TYPE_CHECKING:
    import xarray as xr

Source = tuple[str, str, int]

# Attributes of a data file's run: the gravest status of its checks, and what they said.
QUALITY, FINDINGS = "quality", "findings"

# The netCDF library is not safe under threads, which some executors use.
NETCDF = threading.Lock()
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)
_LITTLE = 1 << 20
_PACKAGE = Path(__file__).parents[1]
UNFINISHED = ".part"


@dataclass(frozen=True)
class RunTask:
    """A run to process, and the folder for its data file."""

    run: PlannedRun
    folder: Path

    @property
    def data_file(self) -> str:
        """Path of the data file relative to the results folder."""
        return f"data/{self.run.name}.nc"


@dataclass(frozen=True)
class CurveTask:
    """Data files of the runs that make one measured curve."""

    curve: CurveOutcome
    data_files: tuple[str, ...]
    folder: Path


@dataclass(frozen=True)
class RunRecord:
    """What a worker hands back: the outcome and the files that were read."""

    outcome: RunOutcome
    sources: tuple[Source, ...]
    zero: RunZero | None = None


def process_run(task: RunTask) -> RunRecord:
    """Read a run, find its segments, compute its friction, write its data file.

    What goes wrong with the run is in the record.

    Raises
    ------
    OutputError
        If the results cannot be written: that is no fault of the run.
    """
    began = time.monotonic()
    run = task.run
    try:
        signals, segments, friction, slip, quality = _analyse(run)
        groups = {"run": signals, "segments": segments, "friction": friction, "stick_slip": slip}
        write_data({None: _root(run, signals.attrs)} | groups, task.folder / task.data_file)
    except OutputError:
        raise
    except Exception as error:  # recorded: one bad file must not stop the others
        reason, name = explain(error)
        outcome = failed_run(run, reason, name, time.monotonic() - began)
        return RunRecord(outcome, tuple(source_of(*pair) for pair in _files(run)))
    load = run.normal_force
    if load is None:
        load = signals.attrs.get("set_normal_force_N")
    outcome = RunOutcome(
        name=run.name,
        files=run.labels,
        surface=run.surface,
        medium=run.medium,
        normal_force=None if load is None else float(load),
        status="done",
        data_file=task.data_file,
        seconds=time.monotonic() - began,
        segments=segments.sizes["segment"],
        quality=quality,
    )
    zero = zero_of(friction.attrs, str(signals.attrs.get("instrument", "")), run.instrument)
    return RunRecord(outcome, sources_of(run, signals.attrs), zero)


def process_curve(task: CurveTask) -> None:
    """Combine the segments of several runs into a measured curve and write it.

    Raises
    ------
    TribolabError
        If the runs make no curve.
    """
    from tribolab.friction.repeatability import run_levels
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.io.netcdf import read_netcdf

    with NETCDF:
        frictions = [read_netcdf(task.folder / name, group="friction") for name in task.data_files]
    curve = measured_stribeck_curve(frictions)
    if len(frictions) > 1:
        curve = stamp(curve.assign(run_level=("run", run_levels(frictions))))
    curve.attrs.update(_labels(task.curve), runs="; ".join(task.curve.run_names))
    shaped = [friction.attrs.get("config_sha256", "") for friction in frictions]
    curve.attrs["config_sha256"] = sha256_of(shaped)
    write_data({None: curve}, task.folder / task.curve.data_file)


def failed_run(run: PlannedRun, reason: str, error: str, seconds: float = 0.0) -> RunOutcome:
    """Return the outcome of a run that has no results."""
    return RunOutcome(
        name=run.name,
        files=run.labels,
        surface=run.surface,
        medium=run.medium,
        normal_force=run.normal_force,
        status="failed",
        reason=reason,
        error=error,
        seconds=seconds,
    )


def explain(error: BaseException) -> tuple[str, str]:
    """Return one line that says what went wrong, and the class name of the error.

    It is for the records of a campaign, whose readers have a campaign file before them.
    An error that nobody raised on purpose also says where it happened.
    """
    name = type(error).__name__
    if isinstance(error, TribolabError):
        return " ".join(error.told("campaign").split()), name
    text = brief(error) if str(error) else ""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{shown(Path(str(error.filename)).name)}: {error.strerror.lower()}", name
    where = ""
    if frames := traceback.extract_tb(error.__traceback__):
        ours = [frame for frame in frames if Path(frame.filename).is_relative_to(_PACKAGE)]
        frame = (ours or frames)[-1]
        where = f" at {Path(frame.filename).name}:{frame.lineno}"
    return f"crashed with {name}{where}: {text}" if text else f"crashed with {name}{where}", name


def sources_of(run: PlannedRun, attrs: dict[str, Any]) -> tuple[Source, ...]:
    """Return the files of a run with the checksums that were taken while reading."""
    known = dict(checksums(attrs))
    return tuple(
        (label, known[as_text(file.name)], file.stat().st_size)
        if as_text(file.name) in known
        else source_of(file, label)
        for file, label in _files(run)
    )


def checksums(attrs: dict[str, Any]) -> list[tuple[str, str]]:
    """Return name and sha256 of the sources that a product's attributes name, sorted."""
    names, sums = (str(attrs.get(key, "")).split("; ") for key in ("source", "source_sha256"))
    return sorted(zip(names, sums, strict=False))


def _files(run: PlannedRun) -> list[tuple[Path, str]]:
    return list(zip(run.files, run.labels, strict=True))


def source_of(file: Path, label: str) -> Source:
    """Return label, checksum and size of a file; no checksum if it cannot be read."""
    try:
        return label, sha256_of_file(file), file.stat().st_size
    except OSError:  # vanished or unreadable: the outcome of its run says so
        return label, "", 0


def _analyse(run: PlannedRun) -> tuple[xr.Dataset, xr.Dataset, xr.Dataset, xr.Dataset, str]:
    from tribolab.friction.coefficient import friction_coefficient
    from tribolab.friction.segments import find_segments
    from tribolab.friction.stick_slip import stick_slip
    from tribolab.io.runs import read
    from tribolab.qc.run_checks import check_run

    files = list(run.files)
    signals = read(
        files if len(files) > 1 else files[0], run.instrument, clock_shift=run.clock_shift
    )
    if run.clock_shift is not None and "clock_shift_source" not in signals.attrs:
        missing = signals.attrs.get("companion_missing", "")
        raise ConfigError(
            f"{signals.attrs['source']}: there is no second log"
            f"{missing and f' ({missing})'} whose clock could be shifted; "
            "leave clock_shift out of its [[run]]"
        )
    if run.normal_force is not None:
        signals.attrs["set_normal_force_N"] = run.normal_force
    if run.sliding_speed is not None:
        signals.attrs |= _stated_speed(signals, run.sliding_speed)
    segments = find_segments(signals, **run.segments)
    friction = friction_coefficient(signals, segments, **run.friction)
    friction.attrs.update(attributes(friction, run.friction.get("other_zeros", ())))
    slip = stick_slip(signals, segments)
    found = check_run(signals, segments, friction, slip, **run.quality)
    signals = found.flagged
    signals.attrs.update({QUALITY: found.status, FINDINGS: found.rows})
    for data in (signals, segments, friction, slip):
        data.attrs.update(_labels(run), config_sha256=run.config_sha256)
    return signals, segments, friction, slip, found.status


def _stated_speed(signals: xr.Dataset, speed: float) -> dict[str, str | float]:
    """Attributes of a run whose speed the campaign file says.

    The segments take it where nothing was recorded; else the check of the speed compares with it.
    """
    own = signals.attrs.get("set_speed_m_s", speed)
    if "set_speed" in signals or not math.isclose(own, speed, rel_tol=1e-6):
        raise ConfigError(
            f"{signals.attrs['source']}: the file says its set speed itself; "
            "leave sliding_speed out of its [[run]]"
        )
    return {"set_speed_m_s": speed, "set_speed_source": "campaign file"}


def _root(run: PlannedRun, attrs: dict[str, Any]) -> xr.Dataset:
    """Attributes of the whole file, for those who open it without naming a group."""
    import xarray as xr

    origin = made(
        f"friction of {run.name}",
        source=attrs["source"],
        source_sha256=attrs["source_sha256"],
        config_sha256=run.config_sha256,
    )
    return xr.Dataset(attrs=_labels(run) | origin | {QUALITY: attrs[QUALITY]})


def _labels(what: PlannedRun | CurveOutcome) -> dict[str, str]:
    return {"run_name" if isinstance(what, PlannedRun) else "curve_name": what.name} | {
        key: value for key in ("surface", "medium") if (value := getattr(what, key))
    }


def write_data(groups: dict[str | None, xr.Dataset], path: Path) -> None:
    """Write a data file, whole or not at all.

    A scheduler may repeat work whose worker died after it was done: readers of the file then go
    on with the old one until the new one, of the same content, is complete.
    """
    from tribolab.io.netcdf import write_netcdf

    part = path.with_name(f"{path.stem}.{uuid.uuid4().hex}{UNFINISHED}")
    try:
        with NETCDF:
            for group, data in groups.items():
                write_netcdf(data, part, group=group)
        part.replace(path)
    except (OSError, RuntimeError, TribolabError) as error:
        # a full disk reaches Python as ENOSPC, or as the HDF5 library's "HDF error"
        full = shutil.disk_usage(path.parent).free < _LITTLE if path.parent.is_dir() else False
        cause = error.__cause__ if isinstance(error, TribolabError) else error
        number = errno.ENOSPC if full else getattr(cause, "errno", None)
        part.unlink(missing_ok=True)
        if number == errno.ENOSPC:
            raise OutputError(
                f"{path.name}: the disk is full; make room or choose another folder with --output"
            ) from error
        if number in _NO_ROOM or not path.parent.is_dir():
            raise OutputError(f"{path.name}: cannot be written ({brief(error)})") from error
        raise
