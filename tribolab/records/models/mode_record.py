"""Record of the sliding mode of one measured contact."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from tribolab.records.annotations import one_of
from tribolab.records.parts import CurveOutcome, ModelOutcome, Row


@dataclass(frozen=True)
class EvidenceRow:
    """Piece of evidence: for or against an adhesion-controlled mode, or neutral."""

    side: Annotated[str, one_of("for", "against", "neutral")]
    text: str
    topic: str


@dataclass(frozen=True)
class ModeRecord:
    """Sliding mode of one measured curve.

    Parameters
    ----------
    curve
        Name of the measured curve; "" if the mode could not be assessed.
    condition
        Surface, medium and load in words.
    verdict, text, paragraph, decide
        See `tribolab.regime.verdict.SlidingMode`.
    evidence
        Evidence for the verdict.
    numbers
        Numbers by name, with the unit in the name.
    segments, segments_oscillating
        Number examined, and number that oscillate.
    scaling, scaling_exponent, scaling_error
        Whether the frequency is proportional to speed.
    speeds
        A row per sliding speed.
    moves
        Whether stick-slip is significant at any speed.
    """

    curve: str
    condition: str
    verdict: str
    text: str
    paragraph: str
    decide: tuple[str, ...]
    evidence: tuple[EvidenceRow, ...]
    numbers: Row = field(default_factory=dict)
    segments: int = 0
    segments_oscillating: int = 0
    scaling: str = ""
    scaling_exponent: float | None = None
    scaling_error: float | None = None
    speeds: tuple[Row, ...] = ()
    moves: bool = False


_MAX_NAMED = 3  # runs


def condition(curve: CurveOutcome | ModelOutcome) -> str:
    """Name of a curve or its model by surface, medium and load.

    Without surface and medium the runs give the name.
    """
    words = curve.surface
    if curve.medium:
        words += f" {curve.medium}" if curve.medium == "dry" else f" in {curve.medium}"
    if not words.strip():
        runs = curve.run_names if isinstance(curve, CurveOutcome) else ()
        words = ", ".join(runs) if 0 < len(runs) <= _MAX_NAMED else curve.name
    if curve.normal_force is not None:
        words += f" at {curve.normal_force:g} N"
    return words.strip()
