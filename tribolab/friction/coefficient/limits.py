"""Limits for the friction coefficient of a segment, its static friction and its trend."""

from tribolab.core.limit import Count, Limit

MAX_CYCLES_OF_ONE_SIGN = Limit(
    0.8, "1", "share of cycles whose strokes have the same sign, above which the sign was lost"
)
MIN_SAMPLES_OF_MIDDLE = Count(3, "1", "samples in the middle part of a stroke")
MIN_ERRORS_OF_PEAK = Limit(3.0, "1", "standard errors between a peak and the sliding friction")
MIN_SAMPLES_OF_PEAK = Count(5, "1", "samples in a fit of a parabola to the peak")
MAX_MISFIT_OF_PEAK = Limit(
    2.0, "1", "standard deviations of the scatter about a parabola, above which a narrower part "
    "is fitted",
)  # fmt: skip
MAX_TIME_BEFORE_SEGMENT = Limit(
    0.5, "1", "share of the preceding stroke in which a rise may already begin",
)  # fmt: skip
MAX_TIME_OF_RISE = Limit(
    0.5, "1", "share of the segment in which the static friction is looked for"
)
MAX_FORCE_BEFORE_RISE = Limit(
    0.3, "1", "share of the sliding friction at the start of a segment that includes the rise"
)
TREND_BY_CHANCE = Limit(
    0.01,
    "1",
    "chance of a trend below which friction is not steady: runs have hundreds of segments",
)
SUSPECT_DRIFT = Limit(
    0.05, "1", "change along a segment divided by the run's friction, above the usual scatter of "
    "repeats",
)  # fmt: skip
FAILING_DRIFT = Limit(
    0.50, "1", "change along a segment divided by the run's friction, above which the mean has "
    "no meaning",
)  # fmt: skip
MIN_EFFECTIVE_SAMPLES = Limit(
    10.0, "1", "with fewer effective samples, a trend cannot be distinguished from slow drift"
)
MIN_SEGMENTS_OF_STRICTER_TREND = Count(
    20, "1", "number of segments above which the accepted chance of a trend is lower, as many "
    "are tested",
)  # fmt: skip
