"""Limits for the alignment of two logs' clocks, and for the validity of a clock."""

from tribolab.core.limit import Count, Limit

_PAIRS = "judgement; checked by tests/coverage/clock_shift_coverage.py, seeds 1000 to 1019"

MIN_DURATION_OF_STROKE = Limit(
    0.1, "1", "least duration of a stroke, divided by that of the longest fast one; less is noise",
    _PAIRS,
)  # fmt: skip
MAX_SLACK = Limit(3e-4, "m", "largest slack of a drive", _PAIRS)
MIN_SPEED_OF_STROKE = Limit(
    0.03, "1", "least speed of a stroke that is compared, as a share of the highest speed", _PAIRS
)
MIN_DISTANCE_OF_SHIFTS = Limit(
    0.25, "1", "least difference of two distinct shifts, divided by the duration of a fast stroke",
    _PAIRS,
)  # fmt: skip
MIN_CHANGES_IN_LOG = Limit(
    0.8, "1", "changes of motion within the force log at the better shift, divided by those at a "
    "rejected one, at least", _PAIRS,
)  # fmt: skip
MIN_LIKELIHOOD_RATIO = Limit(
    6.0, "1", "least ln likelihood ratio for which a shift is decisively better", _PAIRS
)
MIN_MISFIT_OF_RIVAL = Limit(
    4.0, "1", "least unexplained variance of a rejected shift, divided by that of the better one, "
    "since no model is exact", _PAIRS,
)  # fmt: skip
MIN_LIKELIHOOD_WITH_FEWER_CHANGES = Limit(
    30.0, "1", "least ln likelihood ratio of a better shift that halves the unexplained variance",
    _PAIRS,
)  # fmt: skip
MIN_MISFIT_WITH_FEWER_CHANGES = Limit(
    2.0, "1", "least unexplained variance of a rejected shift, divided by that of the better one, "
    "if the likelihood ratio is very large", _PAIRS,
)  # fmt: skip
MIN_OVERLAP = Limit(
    0.6, "1", "least overlap of the two logs, divided by the largest possible one", _PAIRS
)
MIN_EXPLAINED_VARIANCE = Limit(
    0.2, "1", "least share of the variance of the force that velocity classes explain", _PAIRS
)
MIN_CONTRAST = Limit(
    0.1, "1", "least explained variance at the best shift minus its median over all shifts", _PAIRS
)
ROUNDING_OF_VARIANCE = Limit(
    1e-3, "1", "share of the variance below which two shifts are equally good", _PAIRS
)
MIN_RIVAL_PEAK = Limit(
    0.98, "1", "explained variance divided by that of the best shift, above which the shift "
    "nearest to the dates is taken", _PAIRS,
)  # fmt: skip
DECADES_TO_REST = Count(
    5, "1", "decades below the highest speed at which motion counts as rest", _PAIRS
)
MAX_BACKWARD_STEPS = Count(
    10_000, "1", "most small backward steps examined one by one; a clock with more of them jitters"
)
MAX_JITTER = Limit(5.0, "1", "largest backward step that may be jitter, in usual intervals")
MAX_SCATTER_OF_JITTER = Limit(8.0, "1", "the same, in robust standard deviations of the intervals")
MIN_ROWS_PER_STRAY_BLOCK = Count(
    50, "1", "rows of a log per row of a block with wrong times, at least; a block may always "
    "have ten rows",
)  # fmt: skip
ERROR_OF_MODELS = Limit(
    1.5, "1", "factor on the error of the shift by the models, since none of them is exact", _PAIRS
)
MAX_UNEXPLAINED_VARIANCE = Limit(
    0.5, "1", "largest share of the variance of the force that a fit by the motion may leave",
    _PAIRS,
)  # fmt: skip
MAX_GAP_BETWEEN_LOGS = Limit(
    3600.0, "s", "time between two logs above which they are refused; computer clocks differ by "
    "less",
)  # fmt: skip
MAX_GAP_OF_ONE_RUN = Limit(
    60.0, "s", "time between two logs above which a shift from their signals is refused"
)
MAX_NOISE_OF_SPEED = Limit(
    0.02, "1", "largest noise after averaging, divided by the highest speed", _PAIRS
)
MIN_SPEED_OVER_NOISE = Limit(
    4.0, "1", "least peak speed of motion, in standard deviations of the noise", _PAIRS
)
MIN_DISTANCE_OF_MOTION = Limit(
    3e-4, "1", "least distance of motion, divided by the longest distance; less is noise at rest",
    _PAIRS,
)  # fmt: skip
MAX_CHANGES_OF_NOISE = Limit(
    1.5, "1", "changes of the raw direction divided by those of the smoothed one, up to which a "
    "speed signal is quiet at rest", _PAIRS,
)  # fmt: skip
MAX_INTERVAL_OF_COUNTS = Limit(
    3.0, "1", "largest time between two counts of an encoder within a stroke, divided by the "
    "usual time", _PAIRS,
)  # fmt: skip
MIN_COUNTS_OF_STROKE = Count(8, "1", "fewest counts of an encoder in a stroke", _PAIRS)
MIN_LENGTH_OF_STROKE = Limit(
    1e-3, "1", "least length of a stroke, divided by that of the longest; less is noise at rest",
    _PAIRS,
)  # fmt: skip
MIN_SPEED_OF_ONSET = Limit(
    0.1, "1", "least speed of a stroke whose onset is used, divided by the highest speed; slower "
    "onsets are too gradual", _PAIRS,
)  # fmt: skip
MIN_PEAK_OF_LIKELIHOOD = Limit(
    20.0, "1", "least ln likelihood of the best shift, relative to both sides; noise alone gives "
    "less", _PAIRS,
)  # fmt: skip
LIKELIHOOD_AT_UNCERTAINTY = Limit(
    4.0, "1", "decrease of ln likelihood at the limits of the uncertainty", _PAIRS
)
MIN_F_RATIO = Limit(
    10.0, "1", "least F ratio at which velocity classes alone determine the shift", _PAIRS
)
MIN_F_RATIO_WITH_FIT = Limit(1.5, "1", "the same, if a fit by the motion agrees", _PAIRS)
MAX_UNEXPLAINED_OF_AGREEMENT = Limit(
    0.3, "1", "largest share of the variance that a fit by the motion may leave if it is to "
    "confirm the shift", _PAIRS,
)  # fmt: skip
MAX_UNCERTAINTY_OF_SHIFT = Limit(
    0.1, "1", "largest uncertainty of a shift, divided by the duration of a stroke (or of a "
    "velocity class)", _PAIRS,
)  # fmt: skip
MAX_MISFIT_OF_STARTS = Limit(
    3.0, "1", "largest unexplained variance at the shift of the starts, divided by that of the "
    "classes", _PAIRS,
)  # fmt: skip
MIN_EXPLAINED_OF_STARTS = Limit(
    0.95, "1", "least explained variance at the shift of the starts, divided by that of the "
    "classes", _PAIRS,
)  # fmt: skip
ERROR_WITHOUT_FIT = Limit(
    0.004, "1", "error added to a combined shift, divided by the duration of a stroke, if slow "
    "and fast strokes do not confirm it", _PAIRS,
)  # fmt: skip
MAX_ERROR_OF_STARTS = Limit(
    10.0, "1", "error of the starts, divided by that of the classes, above which the starts "
    "contradict one another", _PAIRS,
)  # fmt: skip
ERROR_OF_METHODS = Limit(
    1.3, "1", "factor on the error of a combined shift, since all methods may be late alike", _PAIRS
)
MAX_SPEED_RATIO = Limit(
    300.0, "1", "ratio of highest to lowest speed above which slow starts would show a delay",
    _PAIRS,
)  # fmt: skip
MAX_DISTANCE_TO_CLASSES = Limit(
    0.5, "1", "difference between the combined shift and that of the classes, divided by the "
    "duration of a stroke, above which other shifts are tried", _PAIRS,
)  # fmt: skip
MIN_ERROR_OF_SHIFT = Limit(
    0.0005, "1", "least error of a shift, divided by the duration of a stroke, since no method is "
    "better", _PAIRS,
)  # fmt: skip
MIN_SHARE_OF_DIFFERENCE = Limit(
    0.15, "1", "least share of the squared difference of two methods that the error includes",
    _PAIRS,
)  # fmt: skip
MAX_DELAY_OF_CLASSES = Limit(
    0.06, "1", "largest difference between classes and starts that agree, divided by the duration "
    "of a stroke", _PAIRS,
)  # fmt: skip
MAX_ERROR_OF_CONFIRMATION = Limit(
    3.0, "1", "error of a fit, divided by that of the starts, above which it confirms little",
    _PAIRS,
)  # fmt: skip
MAX_ERRORS_OF_AGREEMENT = Limit(
    3.0, "1", "largest difference of two methods that agree, in standard deviations"
)
MAX_MISFIT_OF_RIVAL = Limit(
    1.5, "1", "unexplained variance divided by that of the best shift, below which another shift "
    "is as good", _PAIRS,
)  # fmt: skip
MAX_MISFIT_OF_FIT = Limit(
    3.0, "1", "largest variance that the fit leaves, divided by that left by the classes, if fits "
    "are to decide between shifts", _PAIRS,
)  # fmt: skip
MIN_EXPLAINED_OF_RIVAL = Limit(
    0.8, "1", "explained variance divided by that of the best shift, above which another shift "
    "may be as good", _PAIRS,
)  # fmt: skip
MAX_UNEXPLAINED_OF_PLACE = Limit(
    0.1, "1", "share of the variance left by a fit, below which the fit shows the shift within "
    "half a stroke", _PAIRS,
)  # fmt: skip
MAX_ERROR_OF_DATES = Limit(
    10.0, "s", "largest difference between a shift and the dates of both logs, if the dates are "
    "to select it",
)  # fmt: skip
CLOCK_RATE_ERROR = Limit(
    10e-6, "1", "standard deviation of the relative rate of two quartz clocks",
    "data sheets of quartz oscillators: 10 to 50 ppm",
)  # fmt: skip
MAX_LIKELIHOOD_OF_START = Limit(
    20.0, "1", "largest ln likelihood by which one start can contradict a shift", _PAIRS
)
MAX_ERROR_OF_CLOCK_RATE = Limit(
    0.3, "1", "error of the fitted clock rate, divided by the expected one, above which the rate "
    "is not fitted", _PAIRS,
)  # fmt: skip
