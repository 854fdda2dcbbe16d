"""All that is recorded of one run."""

from __future__ import annotations

from dataclasses import dataclass

from tribolab.records.parts import FlaggedSpan, Notice, Row, RunOutcome, RunZero, Source


@dataclass(frozen=True)
class Highlight:
    """Mean friction over the strokes at one speed [m/s], with its scatter and its error."""

    where: str
    sliding_speed_m_s: float | None
    value: float | None
    std: float | None
    sem: float | None
    segments: int


@dataclass(frozen=True)
class LeftOut:
    """What was left out of a run for one reason: how often, how long [s]."""

    reason: str
    intervals: int
    duration_s: float | None


@dataclass(frozen=True)
class CheckRow:
    """What one check said of a run, and how a person settled it, if one did."""

    check: str
    status: str
    variable: str
    message: str
    value: float | None
    unit: str
    decision: str = ""


@dataclass(frozen=True)
class DecisionRow:
    """One decision on a run: what, when in the run [s], why, by whom, and what came of it.

    `segments` has the numbers of those that it touches, from 1; the friction coefficients are means
    over these, with all decisions on the run (without the rejected ones) and as they were found.
    """

    action: str
    start_s: float | None
    stop_s: float | None
    new_start_s: float | None
    new_stop_s: float | None
    reason: str
    author: str
    date: str
    segments: tuple[int, ...] = ()
    effect: str = ""
    friction_coefficient: float | None = None
    friction_coefficient_as_found: float | None = None

    @property
    def where(self) -> str:
        """What of the run it is about."""
        if self.start_s is None:
            return "the run"
        return f"segment {self.segments[0]}" if self.segments else "a segment"

    def row(self) -> Row:
        """Return it as a row of a table."""
        facts: Row = {
            name: getattr(self, name) for name in self.__dataclass_fields__ if name != "segments"
        }
        return facts | {"segments": "; ".join(map(str, self.segments))}


@dataclass(frozen=True)
class Waveform:
    """The class of stick-slip of a run, and where it is seen."""

    class_: str
    detail: str


@dataclass(frozen=True)
class RunFacts:
    """Numbers of a run, as report.json has them: SI, units in the names, None if not known.

    A run that failed has the defaults.
    """

    quantity: str | None = None
    value_min: float | None = None
    value_max: float | None = None
    relative_scatter: float | None = None
    relative_drift: float | None = None
    unsteady_segments: int = 0
    stick_slip: Waveform | None = None
    sliding_speed_min_m_s: float | None = None
    sliding_speed_max_m_s: float | None = None
    offset: str = ""
    trim: float | None = None
    position_range_m: tuple[float, float] | None = None
    velocity_source: str = ""
    instrument: str = ""
    quality: str = ""
    checks: tuple[CheckRow, ...] = ()
    decisions: tuple[DecisionRow, ...] = ()
    recorded_at: str = ""
    duration_s: float | None = None
    samples: int = 0
    signals: tuple[str, ...] = ()
    columns_not_used: tuple[str, ...] = ()
    clock_shift_s: float | None = None
    clock_shift_uncertainty_s: float | None = None
    clock_shift_source: str = ""
    history: str = ""
    highlights: tuple[Highlight, ...] = ()
    omitted: tuple[LeftOut, ...] = ()
    segments: tuple[Row, ...] = ()
    flagged: tuple[FlaggedSpan, ...] = ()


@dataclass(frozen=True)
class RunRecord:
    """One run: what it came to, from which files, its numbers, and what is said of it.

    Parameters
    ----------
    outcome
        The little that the rest of a campaign has to know.
    sources
        The files that were read.
    zero
        What it says of the zero of its friction force; None of a run that failed.
    facts
        Its numbers.
    notices
        What a reader should know of it.
    slip
        Its stick-slip, a row per segment.
    """

    outcome: RunOutcome
    sources: tuple[Source, ...]
    zero: RunZero | None = None
    facts: RunFacts = RunFacts()
    notices: tuple[Notice, ...] = ()
    slip: tuple[Row, ...] = ()
