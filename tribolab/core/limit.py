"""A number that decides a result, with what it was chosen for and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limit:
    """A number that drives a decision.

    Attributes
    ----------
    value
        In `unit`.
    unit
        An SI unit, or ``"1"``.
    reason
        What the number limits, and why it has this size.
    source
        The script and seeds it was calibrated on, a standard with its clause, a paper with its DOI,
        or ``"judgement"``.

    Examples
    --------
    >>> Limit(0.05, "1", "smallest share of the load that counts as contact").source
    'judgement'
    """

    value: float
    unit: str
    reason: str
    source: str = "judgement"
