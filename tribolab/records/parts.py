"""One small record per run, curve, surface and model, and what is said of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

from tribolab.core.validity import reasons_of
from tribolab.records.annotations import one_of

if TYPE_CHECKING:
    import xarray as xr


BAD = ("fail", "error", "rejected")  # qualities of a run of which nothing goes into the curves


class HasStatus:
    """What says by its status what it came to."""

    status: str

    @property
    def done(self) -> bool:
        """Whether there are results."""
        return self.status == "done"


@dataclass(frozen=True, kw_only=True)
class PartOutcome(HasStatus):
    """What a part that files are read for came to, and where its data are.

    Parameters
    ----------
    name
        Unique among parts of its kind.
    status
        "done", "failed", or "skipped" if the campaign file knows too little for it.
    reason
        Why it failed, in one line; "" for a part that is done.
    error
        Class name of the error; "" for a part that is done.
    data_file
        Path of the netCDF file relative to the results folder; "" for a failed part.
    reused
        Whether the data file was taken over from the previous results.
    seconds
        Time [s] that the part took.
    kept
        Since when and why these are earlier results, because a file cannot be read now; "" for
        everything else.
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
    """One run: done or failed; its name is safe as a file name.

    Parameters
    ----------
    files
        Raw files, relative to the campaign file.
    surface, medium
        As the campaign file calls them; "" where it says nothing.
    normal_force
        Set-point [N] of the campaign file, else of the raw file; else the mean of what was
        measured, the same for repeats; None where neither is known.
    load_from
        Where that is from: `LOAD_STATED`, `LOAD_MEASURED`, `LOAD_VARIES` where the run has several
        loads, "" where nothing tells.
    measured_load
        Mean load [N] while the run slides, where none is stated.
    measured_levels, load_levels
        Where it slides under several loads, mean [N] of each and the load [N] it is filed under,
        the same for repeats; none where the load rises or falls all the time.
    segments
        Number of segments found.
    quality
        Gravest finding of the checks on the raw data: "pass", "suspect", "fail", "error", or "" for
        a run that could not be checked; "accepted" or "rejected" where a person decided.
    segments_rejected
        Number of segments, among those found, that a person rejected.
    quality_as_found
        What `quality` would be without decisions; "" where nobody decided.
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

    @property
    def in_curves(self) -> bool:
        """Whether it goes into the measured curves."""
        left = self.segments - self.segments_rejected
        return self.done and left > 0 and self.quality not in BAD

    @property
    def in_curves_as_found(self) -> bool:
        """Whether it would without a person's decisions."""
        quality = self.quality_as_found or self.quality
        return self.done and self.segments > 0 and quality not in BAD


@dataclass(frozen=True)
class CurveOutcome(HasStatus):
    """One measured curve: the runs of one surface, medium and load, taken together.

    `status`, `reason` and `load_from` are as for a run; `data_file` is "" for a curve that failed.
    `crash` is the traceback of an error that nobody raised on purpose, else "".
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
Row = dict[str, Cell]  # of a table: by the column's name, with its unit; None where not known


def number_of(row: Row, column: str) -> float | None:
    """Return the number in a column of a row; None where it is not known.

    Raises
    ------
    TypeError
        If the column has texts.

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
    """A finding as the report shows it: how grave, of which run, where, and what."""

    severity: str
    run: str
    where: str
    message: str


class RunZero(NamedTuple):
    """What a run's result says of its zero.

    Parameters
    ----------
    instrument
        What recorded it; "" where that is not known, and then nothing is lent.
    own
        Its own zero [N], or None.
    lent
        What other runs lent to it, as text; None where it wants nothing.
    """

    instrument: str
    own: float | None
    lent: str | None


class Finding(NamedTuple):
    """Something that a reader of the results should know: "fail", "error", "suspect", "note".

    `check` is the name of the check on the raw data that says so; "" for everything else.
    """

    severity: str
    message: str
    check: str = ""


def beyond_limits(groups: Mapping[str, xr.Dataset]) -> list[Finding]:
    """Return a finding for each limit of the theory that a result leaves, see `validity`.

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
    """One surface: its spectrum, contact and adhesion, as far as they could be computed.

    Parameters
    ----------
    files
        Scans, relative to the campaign file; those that could not be used are in the findings.
    parts
        Names of the groups in the data file.
    findings
        What went wrong, what was left out, and why.
    quality
        Gravest finding of the checks on the scans that were used, as for a run.
    checks
        What every check said of every scan: a row each, with the scan's file as "scan".
    """

    files: tuple[str, ...]
    parts: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    quality: str = ""
    checks: tuple[Row, ...] = ()

    @property
    def label(self) -> str:
        """Its name; what follows from bad scans must not be taken for the others' like."""
        return self.name + (" (bad scans)" if self.quality in ("fail", "error") else "")

    @property
    def unreadable(self) -> tuple[Finding, ...]:
        """What could not be read or computed."""
        grave = ("fail", "error")
        return tuple(f for f in self.findings if f.severity in grave and not f.check)

    @property
    def objections(self) -> set[str]:
        """Every status that the checks gave to the scans, also to those that were left out."""
        return {f.severity for f in self.findings if f.check and f.severity != "note"}


@dataclass(frozen=True, kw_only=True)
class ModelOutcome(PartOutcome):
    """The model of one measured curve, with the shear stress that was fitted to it.

    Its name is that of the data file: ``model_`` and the curve's name.

    Parameters
    ----------
    curve, surface, medium, normal_force
        The measured curve that it belongs to, as in its `CurveOutcome`.
    parts
        Names of the groups in the data file.
    findings
        What went wrong, what was left out, and why.
    """

    curve: str
    surface: str
    medium: str
    normal_force: float | None
    parts: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True)
class FlaggedSpan:
    """Where checks objected to a signal: suspect or fail, from when to when [s], which checks."""

    signal: str
    severity: Annotated[str, one_of("suspect", "fail")]
    start_s: float
    stop_s: float
    checks: tuple[str, ...]


@dataclass(frozen=True)
class PageTrace:
    """A run's trace for the page, as JSON that may stand in a script element.

    Parameters
    ----------
    coarse
        What is shown at once.
    fine
        With more points, to zoom into; "" if there is none.
    """

    coarse: str
    fine: str = ""
