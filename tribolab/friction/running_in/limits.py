"""Limits for running-in, calibrated by ``tests/coverage/running_in_coverage.py``."""

from tribolab.core.limit import Count, Limit

_TABLE = "tests/coverage/running_in_coverage.py, seed 8"

BY_CHANCE = Limit(5e-4, "1", "chance of a running-in in a sequence that has none", _TABLE)
STEADY_WITHIN = Limit(
    0.01, "1", "relative difference between friction and its asymptote that counts as steady",
    "judgement",
)  # fmt: skip
NOT_FINISHED = Limit(
    0.1, "1", "share of the running-in that may be left at the end of the run", _TABLE
)
LATEST_START = Limit(0.8, "1", "share of the run after which a steady value has too few values")
STEP_OVER_NOISE = Limit(6.5, "1", "standard errors of a step", _TABLE)
STEP_OVER_EXPONENTIAL = Limit(
    1.06, "1", "factor by which the residual squares of a step must be below those of a "
    "running-in", _TABLE,
)  # fmt: skip
LINE_OVER_EXPONENTIAL = Limit(
    0.98, "1", "factor on the residual squares of a line, compared with an exponential", _TABLE,
)  # fmt: skip
SHORT_TIME = Limit(
    0.15, "1", "time constant divided by the duration of the run, below which noise is estimated "
    "at the frequencies of the change", _TABLE,
)  # fmt: skip
LONGEST_CHANGE_AT_END = Limit(
    1 / 3, "1", "longest change at the end of a run, as a share of the run; if it is longer, the "
    "end is the steady part",
)  # fmt: skip
LATEST_PEAK = Limit(
    1 / 3, "1", "share of the run within which friction may first rise, before it runs in", _TABLE
)
BLOCKS_FOR_PEAK = Count(50, "1", "intervals among which the extreme is looked for", _TABLE)
MIN_VALUES = Limit(20, "1", "strokes, or stretches, of a run in which running-in is looked for")
"""As for the trend along a run's strokes; with fewer values Burg's models are unreliable."""
MIN_TIME_AT_ONE_SPEED = Limit(
    0.8, "1", "share of the sliding time at one speed: the rest of such a run is start and stop"
)
MIN_LOAD = Limit(0.2, "1", "share of the usual load, below which a ratio of forces is noise")
