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
MAX_ERROR_OF_BLOCK = Limit(
    0.1, "1", "standard error of a block's speed over the speed: five of them are half of the speed"
)
MIN_DIGITS_OF_BLOCK = Limit(
    5.0,
    "1",
    "digits of the position in a block's way; the slope of two or three digits is arbitrary",
)
