"""Limits for the error of a mean; calibrated by ``tests/coverage/mean_coverage.py``."""

from tribolab.core.limit import Count, Limit

_TABLE = "tests/coverage/mean_coverage.py, seeds 0 to 3; reported on seeds from 100 on"

BLOCKS = Limit(384, "1", "equal stretches of time whose means represent a record", _TABLE)
COARSE_BLOCKS = Limit(
    96, "1", "intervals in which a trend is looked for", _TABLE,
)  # fmt: skip
MAX_LINES = Limit(3, "1", "oscillations that are fitted to a record", "judgement")
MIN_CYCLES = Limit(
    1.2, "1", "fewest cycles of an oscillation that is fitted", _TABLE,
)  # fmt: skip
FEW_CYCLES = Limit(4.0, "1", "cycles below which an oscillation looks like slow drift", _TABLE)
LINE_OVER_NOISE = Limit(
    25.0, "1", "ratio of an oscillation's power to the spectrum of the residual: a chance of "
    "e**-25", _TABLE,
)  # fmt: skip
SLOW_LINE_OVER_NOISE = Limit(
    60.0, "1", "the same for few cycles: noise with a memory of a tenth of the record exceeds 30 "
    "in 10 % of records, 65 in 2 %", _TABLE,
)  # fmt: skip
SLOW_LINE_SHARE = Limit(0.85, "1", "share of the variance that few cycles must explain", _TABLE)
LEFT_IN_BAND = Limit(
    0.2, "1", "share of the power about an oscillation that may remain: else it is no line", _TABLE
)
MAX_COURSES = Limit(
    2, "1", "trends (a line, an exponential) that are fitted to a record", _TABLE,
)  # fmt: skip
COURSE_BY_CHANCE = Limit(
    5e-4, "1", "chance of a trend in a record that has none", _TABLE,
)  # fmt: skip
EXPONENTIAL_OVER_LINE = Limit(
    1.04, "1", "factor by which an exponential must reduce the residual squares more than a line",
    _TABLE,
)  # fmt: skip
CALM = Limit(0.7, "1", "chance, before the record is seen, that it has no slow drift", _TABLE)
COSINES = Limit(24, "1", "lowest cosines of a record that give its drift", _TABLE)
HUMP = Limit(
    4.0, "1", "ratio of the power at the peak of the spectrum to that at the lowest frequencies, "
    "above which slow drift is fitted only below the frequency of the peak", _TABLE,
)  # fmt: skip
MIN_DRIFT_WIDENING = Limit(
    2.0, "1", "ratio of U95 to that from the scatter alone, above which U95 is said to include "
    "slow drift", "judgement",
)  # fmt: skip
MIN_DRIFT_CHANGE = Limit(
    2.0, "1", "change along a segment, in standard errors of its mean, above which drift is "
    "worth a remark: the mean differs from either end by half of the change", "judgement",
)  # fmt: skip
MIN_DRIFT_U95 = Limit(
    0.01, "1", "relative U95 above which drift is worth a remark: repeats scatter by 2 to 5 %, "
    "so a smaller U95 does not affect comparisons; without this limit, 277 of 780 segments of "
    "the demo had a remark", "tribolab demo, results/tables/friction.csv",
)  # fmt: skip
MAX_MEMORY = Limit(
    0.97, "1", "sum of the coefficients of an autoregression: beyond it the variance of the mean "
    "is unbounded", _TABLE,
)  # fmt: skip
MIN_SAMPLES_OF_COURSE = Count(
    16, "1", "fewest samples of a record in which a trend is looked for", _TABLE,
)  # fmt: skip
MIN_SAMPLES_OF_LINE = Count(
    32, "1", "samples of a record in which an oscillation is looked for", _TABLE
)
