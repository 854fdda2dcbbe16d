"""Numbers that decide where a run slides and where it stops."""

from __future__ import annotations

from tribolab.core.limit import Limit

MIN_SHARE_OF_SPEED = Limit(
    0.5, "1", "a position that moves at less than half of the recorded speed stands still"
)
MIN_STANDSTILL = Limit(
    0.06, "1", "share of a segment; two of 32 blocks in a row, so that one wild block is none"
)
MAX_SPEED_MISFIT = Limit(
    0.2, "1", "a position that is further off in most blocks is another quantity or unit"
)
MIN_STEPS_OF_BLOCK = Limit(
    10.0, "1", "way of a block in errors of a position reading; a shorter one shows no standstill"
)
