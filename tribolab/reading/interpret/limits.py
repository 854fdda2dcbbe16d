"""Limits for proofs of columns by other columns."""

from __future__ import annotations

from tribolab.core.limit import Limit

AGREEMENT = Limit(
    0.01, "1", "relative difference between columns that a rule of physics relates: they agree "
    "to the digits with which they are written",
    "te67_pin_on_disc_MIT: speed = rotation x radius to 0.4 % over 1800 rows",
)  # fmt: skip
SPREAD = Limit(
    0.05, "1", "variation of the ratio of both sides of a rule from row to row, between the 10th "
    "and the 90th percentile",
    "te67_pin_on_disc_MIT: 0.9 % for its distance, which is written in whole turns",
)  # fmt: skip
ROWS = Limit(
    10, "rows", "fewest non-zero rows from which a ratio is determined", "judgement",
)  # fmt: skip
