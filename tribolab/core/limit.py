"""Record of a number that decides a result, with its reason and source."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limit:
    """A number that decides a result, with its unit, reason and source.

    Attributes
    ----------
    value
        In `unit`.
    unit
        An SI unit, or ``"1"``.
    reason
        The quantity it limits, and why it has this size.
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


@dataclass(frozen=True)
class Count(Limit):
    """A limit that is a whole number, e.g. of samples, strokes or periods."""

    value: int
