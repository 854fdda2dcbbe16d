"""Limits for the alignment of two logs' clocks, and for the validity of a clock."""

from tribolab.core.limit import Count, Limit

_PAIRS = "judgement; checked by tests/coverage/clock_shift_coverage.py, seeds 1000 to 1019"

MIN_DURATION_OF_STROKE = Limit(
    0.1, "1", "duration over that of the longest fast stroke; shorter motion is noise", _PAIRS
)
MAX_SLACK = Limit(3e-4, "m", "slack of a drive", _PAIRS)
MIN_SPEED_OF_STROKE = Limit(
    0.03, "1", "share of the fastest speed of a stroke that is compared", _PAIRS
)
MIN_DISTANCE_OF_SHIFTS = Limit(
    0.25, "1", "difference of two shifts, over the duration of a fast stroke, that are not the "
    "same", _PAIRS,
)  # fmt: skip
MIN_CHANGES_IN_LOG = Limit(
    0.8, "1", "share of a rival's changes of motion that the force log includes, if the rival is "
    "rejected", _PAIRS,
)  # fmt: skip
MIN_LIKELIHOOD_RATIO = Limit(6.0, "1", "ln likelihood ratio of the better shift", _PAIRS)
MIN_MISFIT_OF_RIVAL = Limit(
    4.0, "1", "unexplained variance of a rejected shift over that of the better one: no model is "
    "quite right", _PAIRS,
)  # fmt: skip
MIN_LIKELIHOOD_WITH_FEWER_CHANGES = Limit(
    30.0, "1", "ln likelihood ratio of the better shift, if it explains fewer changes", _PAIRS
)
MIN_MISFIT_WITH_FEWER_CHANGES = Limit(
    2.0, "1", "unexplained variance of the rejected shift, if the better one explains fewer "
    "changes", _PAIRS,
)  # fmt: skip
MIN_OVERLAP = Limit(0.6, "1", "overlap of both logs over the largest possible one", _PAIRS)
MIN_EXPLAINED_VARIANCE = Limit(
    0.2, "1", "share of the variance of the force that classes of speed explain", _PAIRS
)
MIN_CONTRAST = Limit(
    0.1, "1", "explained variance at the best shift minus that at most shifts", _PAIRS
)
ROUNDING_OF_VARIANCE = Limit(
    1e-3, "1", "share of the variance that is no difference between shifts", _PAIRS
)
MIN_RIVAL_PEAK = Limit(
    0.98, "1", "explained variance over that of the best shift, from which the shift nearest to "
    "the dates is taken", _PAIRS,
)  # fmt: skip
DECADES_TO_REST = Count(
    5, "1", "decades below the fastest speed, under which motion is rest", _PAIRS
)
MAX_BACKWARD_STEPS = Count(
    10_000, "1", "small backward steps that are examined one by one; a clock with more of them "
    "jitters",
)  # fmt: skip
MAX_JITTER = Limit(5.0, "1", "backward step in usual intervals, up to which it may be jitter")
MAX_SCATTER_OF_JITTER = Limit(8.0, "1", "the same in robust standard deviations of the intervals")
MIN_ROWS_PER_STRAY_BLOCK = Count(
    50, "1", "rows of a log for each row of a block (or ten) whose times are wrong"
)
ERROR_OF_MODELS = Limit(
    1.5, "1", "error of the shift over that by the models: none of them is true", _PAIRS
)
MAX_UNEXPLAINED_VARIANCE = Limit(
    0.5, "1", "share of the variance of the force that a fit by the motion leaves", _PAIRS
)
MAX_GAP_BETWEEN_LOGS = Limit(
    3600.0, "s", "time between two logs above which they are refused: two computers' clocks "
    "differ by less",
)  # fmt: skip
MAX_GAP_OF_ONE_RUN = Limit(60.0, "s", "time between two logs above which their signals are doubted")
MAX_NOISE_OF_SPEED = Limit(0.02, "1", "noise over the fastest speed after averaging", _PAIRS)
MIN_SPEED_OVER_NOISE = Limit(
    4.0, "1", "standard deviations of the noise of a speed that is motion", _PAIRS
)
MIN_DISTANCE_OF_MOTION = Limit(
    3e-4, "1", "distance over the longest one; a shorter one is noise at rest", _PAIRS
)
MAX_CHANGES_OF_NOISE = Limit(
    1.5, "1", "changes of the raw direction over those of the smoothed one, up to which the speed "
    "is quiet at rest", _PAIRS,
)  # fmt: skip
MAX_INTERVAL_OF_COUNTS = Limit(
    3.0, "1", "time between two counts of an encoder over the usual one within a stroke", _PAIRS
)
MIN_COUNTS_OF_STROKE = Count(8, "1", "counts of an encoder that make a stroke", _PAIRS)
MIN_LENGTH_OF_STROKE = Limit(
    1e-3, "1", "length over that of the longest stroke; a shorter one is noise of a stage at rest",
    _PAIRS,
)  # fmt: skip
MIN_SPEED_OF_ONSET = Limit(
    0.1, "1", "speed of a stroke over the highest one; slower onsets are too gradual", _PAIRS
)
MIN_PEAK_OF_LIKELIHOOD = Limit(
    20.0, "1", "ln likelihood of the best shift over both sides: noise alone makes less", _PAIRS
)
LIKELIHOOD_AT_UNCERTAINTY = Limit(
    4.0, "1", "decrease of ln likelihood at the limits of the uncertainty", _PAIRS
)
MIN_F_RATIO = Limit(
    10.0, "1", "F ratio of the classes of speed that shows the shift without other methods", _PAIRS
)
MIN_F_RATIO_WITH_FIT = Limit(1.5, "1", "the same if a fit by the motion agrees", _PAIRS)
MAX_UNEXPLAINED_OF_AGREEMENT = Limit(
    0.3, "1", "variance that a fit by the motion leaves, if it agrees", _PAIRS
)
MAX_UNCERTAINTY_OF_SHIFT = Limit(
    0.1, "1", "uncertainty of a stated shift over the duration of a stroke (of a class of speed, "
    "by classes)", _PAIRS,
)  # fmt: skip
MAX_MISFIT_OF_STARTS = Limit(
    3.0, "1", "unexplained variance at the shift of the starts over that of the classes", _PAIRS
)
MIN_EXPLAINED_OF_STARTS = Limit(
    0.95, "1", "explained variance at the shift of the starts over that of the classes", _PAIRS
)
ERROR_WITHOUT_FIT = Limit(
    0.004, "1", "error of one method over the duration of a stroke, if no fit is available", _PAIRS
)
MAX_ERROR_OF_STARTS = Limit(
    10.0, "1", "error by the starts over that by the classes, above which the starts contradict "
    "one another", _PAIRS,
)  # fmt: skip
ERROR_OF_METHODS = Limit(
    1.3, "1", "error of the shift over that of the methods: all of them may be late alike", _PAIRS
)
MAX_SPEED_RATIO = Limit(
    300.0, "1", "fastest over slowest speed, above which other shifts are tried", _PAIRS
)
MAX_DISTANCE_TO_CLASSES = Limit(
    0.5, "1", "difference between the shifts by classes and by starts over a stroke's duration, "
    "above which other shifts are tried", _PAIRS,
)  # fmt: skip
MIN_ERROR_OF_SHIFT = Limit(
    0.0005, "1", "error of a shift over the duration of a stroke: no method is better", _PAIRS
)
MIN_SHARE_OF_DIFFERENCE = Limit(
    0.15, "1", "share of the squared difference of two methods that the error includes", _PAIRS
)
MAX_DELAY_OF_CLASSES = Limit(
    0.06, "1", "difference between classes and starts that agree, over a stroke's duration", _PAIRS
)
MAX_ERROR_OF_CONFIRMATION = Limit(
    3.0, "1", "error of a fit over that of the starts, above which it confirms little", _PAIRS
)
MAX_ERRORS_OF_AGREEMENT = Limit(3.0, "1", "standard deviations between two methods that agree")
MAX_MISFIT_OF_RIVAL = Limit(
    1.5, "1", "unexplained variance over that of the best shift, below which another shift is as "
    "good", _PAIRS,
)  # fmt: skip
MAX_MISFIT_OF_FIT = Limit(
    3.0, "1", "variance that a fit at another shift leaves over that of the classes, if it is as "
    "good", _PAIRS,
)  # fmt: skip
MIN_EXPLAINED_OF_RIVAL = Limit(
    0.8, "1", "explained variance of another shift over that of the best one, if it is as good",
    _PAIRS,
)  # fmt: skip
MAX_UNEXPLAINED_OF_PLACE = Limit(
    0.1, "1", "variance that a fit leaves which shows the shift within half a stroke", _PAIRS
)
MAX_ERROR_OF_DATES = Limit(
    10.0, "s", "difference between a shift and the dates of both logs, within which the dates "
    "select it",
)  # fmt: skip
CLOCK_RATE_ERROR = Limit(
    10e-6, "1", "standard deviation of the relative rate of two quartz clocks",
    "data sheets of quartz oscillators: 10 to 50 ppm",
)  # fmt: skip
MAX_LIKELIHOOD_OF_START = Limit(
    20.0, "1", "ln likelihood by which one start contradicts a shift", _PAIRS
)
MAX_ERROR_OF_CLOCK_RATE = Limit(
    0.3, "1", "error of the fitted rate over the one expected, if the rate is fitted", _PAIRS
)
