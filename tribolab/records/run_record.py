"""All that is recorded of one run."""

from __future__ import annotations

from dataclasses import dataclass

from tribolab.records.parts import Notice, Row, RunOutcome, RunZero, Source
from tribolab.records.run_facts import RunFacts


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
