"""Verdict on a published number, from the computed value and from the paper's other numbers.

A printed number is called inconsistent only if a power of ten or a reciprocal turns it into the
computed one, if other numbers of the paper exclude it, or if the paper's own inputs give a
different value in closed form.

Agreement is not always a test. A number that is an input, to which an input was fitted, or that
follows from such numbers agrees *by construction*. A number that needs a tolerance above `NARROW`
agrees *within a wide tolerance*. Only the others are called reproduced.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tribolab.core.wording import number, percent
from tribolab.studies.published import Published

REPRODUCED = "reproduced"
BY_CONSTRUCTION = "by construction"
WIDE = "within a wide tolerance"
DIFFERS = "differs"
INCONSISTENT = "published value inconsistent"
MEASURED = "measured, not computed"

NARROW = 0.01  # relative tolerance above which agreement is called wide
_COARSE = 0.05  # relative rounding error above which a printed number is treated as imprecise


class Computed(NamedTuple):
    """Computed value for a published number."""

    value: float  # in SI
    tolerance: float  # relative tolerance
    note: str = ""
    exact: bool = False  # closed form, which must agree to the printed digits
    low: float = math.nan  # ends of a range, if one printed number summarises several
    high: float = math.nan
    given: str = ""  # reason why the number agrees by construction; "" if it does not


class Measured(NamedTuple):
    """Reason why a published number cannot be computed, e.g. because it was measured."""

    note: str


class Own(NamedTuple):
    """Value of a published number that follows from the paper's other numbers."""

    low: float
    high: float
    words: str


BOUNDS = (">", "at most", "below")  # words before a number that is a bound


class Verdict(NamedTuple):
    """Status of a published number, with its reason."""

    status: str
    note: str


def verdict_on(row: Published, computed: Computed | Measured, own: Own | None = None) -> Verdict:
    """Return the verdict on a published number, from theory and the paper's other numbers.

    Parameters
    ----------
    row
        The published number.
    computed
        Theoretical value, or the reason why there is none.
    own
        Value that follows from other numbers of the paper, if any.

    Examples
    --------
    >>> width = Published("half_width", "Smooth", "", "37", "mm", "", "", "")
    >>> verdict_on(width, Computed(3.716e-3, 0.005)).note
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
    status = INCONSISTENT if reasons else _grade(row, computed) if agrees else DIFFERS
    if agrees and computed.given:
        reasons.append(f"by construction: {computed.given}")
    if status == WIDE:
        reasons.append(f"agrees only within {room_text(_tolerance(row, computed))}")
    if agrees and not row.relation and low == high:
        if abs(computed.value - row.si) > computed.tolerance * abs(row.si):
            reasons.append("agrees within the last digit that is printed")
    return Verdict(status, "; ".join([*reasons, computed.note] if computed.note else reasons))


def room_text(tolerance: float) -> str:
    """Return a relative tolerance as text.

    Examples
    --------
    >>> room_text(0.25), room_text(6.385)
    ('25 %', 'a factor of 7.4')
    """
    return percent(tolerance) if tolerance < 1 else f"a factor of {number(1 + tolerance, 2)}"


def _grade(row: Published, computed: Computed) -> str:
    """Return the status of a number that agrees: reproduced, by construction or widely."""
    if computed.given:
        return BY_CONSTRUCTION
    printed = row.last_digit / 2 / abs(row.si) if row.si else 0.0
    rounding = printed if printed <= _COARSE and not row.relation.startswith(BOUNDS) else 0.0
    return REPRODUCED if _relative_distance(row, computed) <= max(NARROW, rounding) else WIDE


def _relative_distance(row: Published, computed: Computed) -> float:
    """Return the relative distance [1] of a computed value, or range, from the printed one."""
    if row.relation == ">" or not row.si:
        return 0.0
    low, high = _range(computed)
    if row.relation.startswith(BOUNDS):
        return max(0.0, high / row.si - 1)
    return max(0.0, low - row.ends[1], row.ends[0] - high) / abs(row.si)


def _tolerance(row: Published, computed: Computed) -> float:
    """Return the relative tolerance of a number [1]: as stated, or half of its last digit."""
    if row.relation.startswith(BOUNDS):
        return computed.tolerance
    return max(computed.tolerance, row.last_digit / 2 / abs(row.si))


def _range(computed: Computed) -> tuple[float, float]:
    low = computed.value if math.isnan(computed.low) else computed.low
    high = computed.value if math.isnan(computed.high) else computed.high
    return low, high


def _agrees(row: Published, computed: Computed) -> bool:
    if row.relation == ">":
        return computed.value > row.si
    if row.relation in ("at most", "below"):
        return computed.value <= row.si * (1 + computed.tolerance)
    low, high = _range(computed)
    half = row.last_digit / 2
    overlaps = low <= row.ends[1] + half and high >= row.ends[0] - half
    return overlaps or _close(row, computed.value, computed.tolerance)


def _close(row: Published, value: float, tolerance: float) -> bool:
    """Return whether a value agrees with the printed one, within its tolerance or last digit."""
    return abs(value - row.si) <= max(tolerance * abs(row.si), row.last_digit / 2)


def _power_of_ten(row: Published, computed: Computed) -> str:
    for factor, words in ((10, "10 times"), (0.1, "a tenth of"), (1e3, "1000 times")):
        if computed.value and _close(row, factor * computed.value, computed.tolerance):
            return words
    return ""
