"""Whether a printed number holds, by the computed one and by other numbers of the same paper.

No verdict is written down here. A printed number is called inconsistent only if a power of ten or
a reciprocal leads from it to the computed one, if other numbers of the paper exclude it, or if the
paper's own inputs fix it in closed form and it is something else.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tribolab.studies.published import Published

REPRODUCED = "reproduced"
DIFFERS = "differs"
INCONSISTENT = "published value inconsistent"
MEASURED = "measured, not computed"


class Computed(NamedTuple):
    """What the theory gives for a published number."""

    value: float  # SI
    tolerance: float  # relative
    note: str = ""
    exact: bool = False  # a closed form of numbers that the paper prints
    low: float = math.nan  # where one printed number stands for several, their range
    high: float = math.nan


class Measured(NamedTuple):
    """Why a published number cannot be computed."""

    note: str


class Own(NamedTuple):
    """What other numbers of the paper say of a published one."""

    low: float
    high: float
    words: str


BOUNDS = (">", "at most", "below")  # relations that say where a number ends, not where it is


class Verdict(NamedTuple):
    """Status of a published number, and why."""

    status: str
    note: str


def judge(row: Published, computed: Computed | Measured, own: Own | None = None) -> Verdict:
    """Judge a published number by the computed one and by other numbers of the same paper.

    Parameters
    ----------
    row
        The published number.
    computed
        What the theory gives, or why it gives nothing.
    own
        What follows from other numbers of the paper, if anything does.

    Examples
    --------
    >>> width = Published("half_width", "Smooth", "", "37", "mm", "", "", "")
    >>> judge(width, Computed(3.716e-3, 0.005)).note
    'the printed number is 10 times the computed one'
    """
    reasons = []
    low, high = row.ends
    if own and (own.high < low - row.last_digit or own.low > high + row.last_digit):
        reasons.append(own.words)
    if isinstance(computed, Measured):
        status = INCONSISTENT if reasons else MEASURED
        return Verdict(status, "; ".join([*reasons, computed.note]))
    agrees = _agrees(row, computed)
    if not agrees and not row.relation.startswith(BOUNDS):
        if power := _power_of_ten(row, computed):
            reasons.append(f"the printed number is {power} the computed one")
        elif _close(row, 1 / computed.value, computed.tolerance):
            reasons.append(
                f"the printed number is the reciprocal: 1/{computed.value:.3g} = "
                f"{1 / computed.value:.3g}"
            )
        elif computed.exact:
            reasons.append("the paper's own inputs give the computed number in closed form")
    status = INCONSISTENT if reasons else REPRODUCED if agrees else DIFFERS
    if agrees and not row.relation and low == high:
        if abs(computed.value - row.si) > computed.tolerance * abs(row.si):
            reasons.append("agrees within the last digit that is printed")
    return Verdict(status, "; ".join([*reasons, computed.note] if computed.note else reasons))


def _agrees(row: Published, computed: Computed) -> bool:
    if row.relation == ">":
        return computed.value > row.si
    if row.relation in ("at most", "below"):
        return computed.value <= row.si * (1 + computed.tolerance)
    low = computed.value if math.isnan(computed.low) else computed.low
    high = computed.value if math.isnan(computed.high) else computed.high
    half = row.last_digit / 2
    overlaps = low <= row.ends[1] + half and high >= row.ends[0] - half
    return overlaps or _close(row, computed.value, computed.tolerance)


def _close(row: Published, value: float, tolerance: float) -> bool:
    """Whether a value agrees with the printed one, within its tolerance or its last digit."""
    return abs(value - row.si) <= max(tolerance * abs(row.si), row.last_digit / 2)


def _power_of_ten(row: Published, computed: Computed) -> str:
    for factor, words in ((10, "10 times"), (0.1, "a tenth of"), (1e3, "1000 times")):
        if computed.value and _close(row, factor * computed.value, computed.tolerance):
            return words
    return ""
