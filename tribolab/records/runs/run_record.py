"""Record of one run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from tribolab.friction.decisions.decision import ACTIONS
from tribolab.qc.register import STATUSES
from tribolab.records.annotations import Columns, Natural, means, one_of
from tribolab.records.parts import FlaggedSpan, Notice, Row, RunOutcome, RunZero, Source
from tribolab.records.runs.running_in_record import RunningIn
from tribolab.records.wording import UNITS

_QUANTITY = "quantity of value_min, value_max and the highlights"
_SCATTER = "median over the segments of standard deviation / |mean|"
_DRIFT = "largest significant change along a segment / mean friction; 0 if none is significant"
_QUALITY = "worst result of the checks on the raw data, or the manual decision"
_SEGMENT = Columns(
    {
        "segment": "number in the run, from 1",
        "start_s": "",
        "stop_s": "",
        "sliding_speed_m_s": "",
        "direction": "",
    },
    {
        "friction_coefficient": "",
        "friction_coefficient_std": "sample standard deviation of the pointwise ratio",
        "friction_coefficient_sem": "standard error of the mean within the run",
        "friction_coefficient_u": "combined standard uncertainty, with calibration if stated",
        "friction_coefficient_dof": "degrees of freedom; null if infinite",
        "friction_coefficient_U95": "expanded uncertainty (95 %)",
    },
    counts=("segment", "direction"),
    values={"direction": (-1, 0, 1)},
    row="one segment: all columns of tables/friction.csv, with the unit in the name",
    open=True,
)


@dataclass(frozen=True)
class Highlight:
    """Mean friction over the strokes at one speed [m/s], with scatter and uncertainty."""

    where: Annotated[str, one_of("slowest", "middle", "fastest", "all")]
    sliding_speed_m_s: float | None
    value: float | None
    std: float | None
    sem: Annotated[
        float | None,
        means("standard error of the mean within the run; excludes scatter between runs"),
    ]
    U95: Annotated[float | None, means("expanded uncertainty (95 %) of the mean within the run")]
    segments: Natural


@dataclass(frozen=True)
class LeftOut:
    """Parts of a run left out for one reason: number and total duration [s]."""

    reason: str
    intervals: Natural
    duration_s: float | None


@dataclass(frozen=True)
class CheckRow:
    """Result of one check on a run, and the manual decision on it, if any."""

    check: str
    status: Annotated[str, one_of(*STATUSES)]
    variable: str
    message: str
    value: float | None
    unit: str
    decision: Annotated[str, means("manual decision on the finding, or empty")] = ""


@dataclass(frozen=True)
class DecisionRow:
    """One decision on a run: action, interval [s], reason, author and effect."""

    action: Annotated[str, one_of(*ACTIONS)]
    start_s: Annotated[
        float | None,
        means("start of the interval that selects the segment; null for the whole run"),
    ]
    stop_s: float | None
    new_start_s: float | None
    new_stop_s: float | None
    reason: str
    author: str
    date: str
    segments: Annotated[tuple[Natural, ...], means("numbers of the affected segments, from 1")] = ()
    effect: str = ""
    friction_coefficient: Annotated[
        float | None, means("mean over these segments with all decisions (rejected ones left out)")
    ] = None
    friction_coefficient_as_found: Annotated[float | None, means("mean without any decision")] = (
        None
    )

    @property
    def where(self) -> str:
        """Return the part of the run it concerns."""
        if self.start_s is None:
            return "the run"
        return f"segment {self.segments[0]}" if self.segments else "a segment"

    def row(self) -> Row:
        """Return the decision as a row of a table."""
        facts: Row = {
            name: getattr(self, name) for name in self.__dataclass_fields__ if name != "segments"
        }
        return facts | {"segments": "; ".join(map(str, self.segments))}


@dataclass(frozen=True)
class Waveform:
    """Stick-slip class of a run, and the speeds at which it occurs."""

    class_: Annotated[str, Field(serialization_alias="class")]
    detail: str


@dataclass(frozen=True)
class RunFacts:
    """Numbers of a run as in report.json: SI, units in the names, None if unknown.

    A run that failed has the defaults.
    """

    quantity: Annotated[str, one_of(*UNITS, meaning=_QUANTITY)] | None = None
    value_min: float | None = None
    value_max: float | None = None
    relative_scatter: Annotated[float | None, means(_SCATTER)] = None
    relative_drift: Annotated[float | None, means(_DRIFT)] = None
    uncertainty_says: Annotated[
        str, means("contributions missing in its uncertainty; empty if complete")
    ] = ""
    unsteady_segments: Natural = 0
    stick_slip: Waveform | None = None
    sliding_speed_min_m_s: float | None = None
    sliding_speed_max_m_s: float | None = None
    offset: str = ""
    trim: float | None = None
    dead_weight_gain: Annotated[
        float | None, means("step of the normal force divided by the dead weight")
    ] = None
    dead_weight_gain_sem: float | None = None
    position_range_m: tuple[float, float] | None = None
    velocity_source: str = ""
    instrument: str = ""
    quality: Annotated[str, one_of("", *STATUSES, "accepted", "rejected", meaning=_QUALITY)] = ""
    checks: tuple[CheckRow, ...] = ()
    decisions: tuple[DecisionRow, ...] = ()
    recorded_at: str = ""
    duration_s: float | None = None
    samples: Natural = 0
    signals: tuple[str, ...] = ()
    columns_not_used: tuple[str, ...] = ()
    time_origin_s: Annotated[float | None, means("time in the file at the first sample")] = None
    clock_shift_s: float | None = None
    clock_shift_uncertainty_s: float | None = None
    clock_shift_source: str = ""
    inertia: str = ""
    history: str = ""
    highlights: tuple[Highlight, ...] = ()
    omitted: tuple[LeftOut, ...] = ()
    running_in: tuple[RunningIn, ...] = ()
    segments: tuple[Annotated[Row, _SEGMENT], ...] = ()
    flagged: tuple[FlaggedSpan, ...] = ()


@dataclass(frozen=True)
class RunRecord:
    """Run with its outcome, source files, numbers and notices.

    Parameters
    ----------
    outcome
        Summary for the later stages of a campaign.
    sources
        The files that were read.
    zero
        Zero of its friction force; None for a failed run.
    facts
        Its numbers.
    notices
        Notices for the reader.
    slip
        Its stick-slip, a row per segment.
    starts
        Its static friction, a row per start of sliding.
    course
        Friction along it, as `tribolab.campaign.runs.running_in.running_in_of` returns it.
    """

    outcome: RunOutcome
    sources: tuple[Source, ...]
    zero: RunZero | None = None
    facts: RunFacts = RunFacts()
    notices: tuple[Notice, ...] = ()
    slip: tuple[Row, ...] = ()
    starts: tuple[Row, ...] = ()
    course: tuple[Row, ...] = ()
