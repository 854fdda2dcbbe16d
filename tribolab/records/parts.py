"""Short records of each run, curve, surface and model, and of findings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

from tribolab.core.validity import reasons_of
from tribolab.records.annotations import one_of

if TYPE_CHECKING:
    import xarray as xr


BAD = ("fail", "error", "rejected")  # qualities that exclude a run from the curves


class HasStatus:
    """Record with a status."""

    status: str

    @property
    def done(self) -> bool:
        """Whether there are results."""
        return self.status == "done"


@dataclass(frozen=True, kw_only=True)
class PartOutcome(HasStatus):
    """Outcome of a part of a campaign that is computed from files.

    Parameters
    ----------
    name
        Unique among parts of its kind.
    status
        "done", "failed", or "skipped" if the campaign file lacks information.
    reason
        Reason of failure in one line; "" for a part that is done.
    error
        Class name of the error; "" for a part that is done.
    data_file
        Path of the netCDF file relative to the results folder; "" for a failed part.
    reused
        Whether the data file was reused from the previous results.
    seconds
        Time [s] that the part took.
    kept
        Date and reason of earlier results that are kept because a file cannot be read; else "".
    """

    name: str
    status: str
    reason: str = ""
    error: str = ""
    data_file: str = ""
    reused: bool = False
    seconds: float = 0.0
    kept: str = ""


@dataclass(frozen=True, kw_only=True)
class RunOutcome(PartOutcome):
    """Outcome of one run; its name is safe as a file name.

    Parameters
    ----------
    files
        Raw files, relative to the campaign file.
    surface, medium
        Names in the campaign file; "" if not stated.
    normal_force
        Set-point [N] of the campaign file, else of the raw file; else the mean measured load,
        equal for repeats; None if unknown.
    load_from
        Source of the load: `LOAD_STATED`, `LOAD_MEASURED`, `LOAD_VARIES` if the run has several
        loads, "" if unknown.
    measured_load
        Mean load [N] while the run slides, if none is stated.
    measured_levels, load_levels
        For a run under several loads, the mean [N] of each and the load [N] assigned to it, equal
        for repeats; empty if the load changes continuously.
    segments
        Number of segments found.
    quality
        Worst status of the checks on the raw data: "pass", "suspect", "fail", "error", or "" for
        a run that could not be checked; "accepted" or "rejected" if a person decided.
    segments_rejected
        Number of found segments that a person rejected.
    quality_as_found
        `quality` without decisions; "" if nobody decided.
    ramp
        Whether it has no segment, because its speed rises or falls for most of the record.
    """

    files: tuple[str, ...]
    surface: str
    medium: str
    normal_force: float | None
    segments: int = 0
    quality: str = ""
    segments_rejected: int = 0
    quality_as_found: str = ""
    load_from: str = ""
    measured_load: float | None = None
    measured_levels: tuple[float, ...] = ()
    load_levels: tuple[float, ...] = ()
    ramp: bool = False

    @property
    def in_curves(self) -> bool:
        """Whether the run is used in the measured curves."""
        left = self.segments - self.segments_rejected
        return self.done and left > 0 and self.quality not in BAD

    @property
    def in_curves_as_found(self) -> bool:
        """Whether the run would be used without a person's decisions."""
        quality = self.quality_as_found or self.quality
        return self.done and self.segments > 0 and quality not in BAD


@dataclass(frozen=True)
class CurveOutcome(HasStatus):
    """Outcome of one measured curve, from the runs of one surface, medium and load.

    `status`, `reason` and `load_from` are as for a run; `data_file` is "" for a curve that failed.
    `crash` is the traceback of an unexpected error, else "".
    """

    name: str
    surface: str
    medium: str
    normal_force: float | None
    data_file: str
    run_names: tuple[str, ...]
    status: str = "done"
    reason: str = ""
    crash: str = ""
    load_from: str = ""


Cell = float | int | str | bool | None
Row = dict[str, Cell]  # row of a table: column name with unit -> value; None if unknown


def number_of(row: Row, column: str) -> float | None:
    """Return the number in a column of a row; None if unknown.

    Raises
    ------
    TypeError
        If the column contains text.

    Examples
    --------
    >>> number_of({"medium": "dry", "pressure_Pa": 2.5e5}, "pressure_Pa")
    250000.0
    """
    value = row.get(column)
    if isinstance(value, str):
        raise TypeError(f"{column} is a text, {value!r}, not a number")
    return value


Source = tuple[str, str, int]  # label, sha256 ("" if it cannot be read), bytes


class Notice(NamedTuple):
    """Finding in the report: severity, run, place, and text."""

    severity: str
    run: str
    where: str
    message: str


class RunZero(NamedTuple):
    """Zero of the friction force of a run, for lending between runs.

    Parameters
    ----------
    instrument
        Instrument; "" if unknown, and then no zero is lent.
    own
        Its own zero [N], or None.
    lent
        Zeros lent by other runs, as text; None if not needed.
    """

    instrument: str
    own: float | None
    lent: str | None


class Finding(NamedTuple):
    """Finding for a reader of the results: "fail", "error", "suspect" or "note".

    `check` is the name of the check on the raw data that found it; else "".
    """

    severity: str
    message: str
    check: str = ""


def limit_findings(groups: Mapping[str, xr.Dataset]) -> list[Finding]:
    """Return a finding for each limit of the theory that a result exceeds, see `validity`.

    Parameters
    ----------
    groups
        Results by the name of their group, with the attribute ``validity_reasons``.
    """
    where: dict[str, list[str]] = {}
    for name, data in groups.items():
        for reason in reasons_of(data.attrs):
            where.setdefault(reason, []).append(name)
    return [Finding("suspect", f"{', '.join(names)}: {reason}") for reason, names in where.items()]


@dataclass(frozen=True, kw_only=True)
class SurfaceOutcome(PartOutcome):
    """Outcome of one surface: spectrum, contact and adhesion, as far as computable.

    Parameters
    ----------
    files
        Scans, relative to the campaign file; unusable ones are in the findings.
    parts
        Names of the groups in the data file.
    findings
        Errors and omissions, with reasons.
    quality
        Gravest finding of the checks on the scans that were used, as for a run.
    checks
        Result of every check on every scan, one row each, with the scan's file as "scan".
    """

    files: tuple[str, ...]
    parts: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    quality: str = ""
    checks: tuple[Row, ...] = ()

    @property
    def label(self) -> str:
        """Name of the surface, marked if its scans failed checks."""
        return self.name + (" (bad scans)" if self.quality in ("fail", "error") else "")

    @property
    def unreadable(self) -> tuple[Finding, ...]:
        """Findings on files that could not be read or results not computed."""
        grave = ("fail", "error")
        return tuple(f for f in self.findings if f.severity in grave and not f.check)

    @property
    def objections(self) -> set[str]:
        """Statuses of the checks on all scans, including unused ones."""
        return {f.severity for f in self.findings if f.check and f.severity != "note"}


@dataclass(frozen=True, kw_only=True)
class ModelOutcome(PartOutcome):
    """Outcome of the model of one measured curve, with the fitted shear stress.

    Its name is that of the data file: ``model_`` and the curve's name.

    Parameters
    ----------
    curve, surface, medium, normal_force
        The measured curve, as in its `CurveOutcome`.
    parts
        Names of the groups in the data file.
    findings
        Errors and omissions, with reasons.
    """

    curve: str
    surface: str
    medium: str
    normal_force: float | None
    parts: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True)
class FlaggedSpan:
    """Interval [s] of a signal flagged as suspect or fail, and by which checks."""

    signal: str
    severity: Annotated[str, one_of("suspect", "fail")]
    start_s: float
    stop_s: float
    checks: tuple[str, ...]


@dataclass(frozen=True)
class PageTrace:
    """Trace of a run for the page, as JSON that is safe in a script element.

    Parameters
    ----------
    coarse
        Points shown on opening.
    fine
        More points, for zooming; "" if there are none.
    """

    coarse: str
    fine: str = ""
