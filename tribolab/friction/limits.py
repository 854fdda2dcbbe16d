"""Numbers that decide how a record is averaged."""

from __future__ import annotations

from tribolab.core.limit import Limit

MAX_UNEVEN = Limit(
    0.01,
    "1",
    "share of the duration by which rows run ahead of even rows: the plain mean is then off by at "
    "most two per cent of what the signal changes by",
    "|mean by rows - mean by time| <= D x total variation (Koksma's inequality)",
)
MIN_GAP = Limit(
    5.0,
    "1",
    "intervals of the rows around it, from which an interval is a gap that nothing was recorded in",
    "late buffers cause gaps of 2 to 3 intervals",
)
