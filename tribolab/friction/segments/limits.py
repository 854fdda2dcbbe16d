"""Limits for the detection of sliding and rest."""

from tribolab.core.limit import Count, Limit

_STROKES = "judgement; checked by tests/detection/stroke_patterns.py, seeds from 10 000"
_TRICKY = "judgement; checked by tests/detection/tricky_runs.py, seeds 0 to 9"
DETECTION = {  # limits of constant speed, the defaults of `find_segments`
    "resolution": Limit(0.02, "1", "relative speed difference that separates two plateaus"),
    "drift": Limit(0.10, "1", "relative speed change within a plateau, above which it is a ramp"),
    "min_samples": Count(10, "1", "fewest samples in a segment"),
    "min_duration": Limit(0.0, "s", "shortest duration of a segment"),
    "max_gap": Limit(
        0.0, "s", "pause between two samples of a segment; 0: a twentieth of the segment"
    ),
    "rest_speed": Limit(
        0.0, "m/s", "speed of the slider at rest; 0: from the noise and the highest speed"
    ),
}
MIN_SHARE_OF_SPEED = Limit(
    0.5, "1", "a position that moves at less than half of the recorded speed stands still"
)
MIN_STANDSTILL = Limit(
    0.06, "1", "share of a segment; two of 32 blocks in a row: one outlier is not a standstill"
)
MAX_SPEED_MISFIT = Limit(
    0.2, "1", "a position that is further off in most blocks is another quantity or unit"
)
MAX_ERROR_OF_BLOCK = Limit(
    0.1, "1", "relative standard error of a block's speed: five of them are half of the speed",
)  # fmt: skip
MIN_DIGITS_OF_BLOCK = Limit(
    5.0, "1", "steps of the position's last digit within a block; the slope of two or three "
    "steps is arbitrary",
)  # fmt: skip
MIN_GRADUAL_END = Limit(
    0.3, "1", "share of a plateau's length over which its speed changes gradually at an end: the "
    "end of a true plateau is more abrupt", _TRICKY,
)  # fmt: skip
MAX_DRIFTS_FROM_PLATEAU = Limit(
    2.5, "1", "allowed drifts by which the speed next to a plateau differs, if it changes "
    "gradually", _TRICKY,
)  # fmt: skip
MIN_CORRELATION_OF_FLUCTUATION = Limit(
    0.35, "1", "correlation of neighbouring bins above which they are a motion, not noise", _TRICKY
)
MAX_VARIANCE_OF_SMOOTH_MOTION = Limit(
    0.35, "1", "ratio of the variances about one smooth motion and about a constant, below which "
    "the speed changes smoothly", _TRICKY,
)  # fmt: skip
MIN_GAIN_OF_CUBIC = Limit(
    40.0, "1", "sum of squares, in variances of the noise, by which a cubic fits better than a "
    "constant", _TRICKY,
)  # fmt: skip
MIN_BINS_OF_CURVATURE = Count(6, "1", "bins in a fit of curvature", _TRICKY)
MIN_SAMPLES_OF_MIDDLE = Count(
    5, "1", "samples in the middle of a crank's stroke; few are enough, as many strokes are "
    "averaged",
)  # fmt: skip
MIDDLE_OF_CRANK_STROKE = Limit(
    0.5, "1", "share of each stroke of a crank that is averaged: its speed changes there by an "
    "eighth", "sine motion: cos(pi/6) = 0.87",
)  # fmt: skip
MAX_TIME_OF_CHANCE_PLATEAUS = Limit(
    0.05, "1", "share of the time of strokes that plateaus cover by chance"
)
MIN_REST_SPEED_OVER_NOISE = Limit(
    0.05, "1", "noise levels of a sample below which a mean speed is rest: the mean over a piece "
    "scatters less than a sample", _TRICKY,
)  # fmt: skip
MIN_ERRORS_OF_RAMP = Limit(
    3.0, "1", "standard errors by which the speed of a piece must change for it to be a ramp",
    _TRICKY,
)  # fmt: skip
MIN_CHANGE_AT_REST = Limit(
    2.0, "1", "change of speed of a piece at rest, in multiples of the rest speed, above which "
    "it is a ramp", _TRICKY,
)  # fmt: skip
MAX_ERRORS_OF_EQUAL_SPEED = Limit(
    3.0, "1", "standard errors between the speeds of two pieces that are joined", _TRICKY
)
MAX_DIFFERENCE_OF_EQUAL_SPEED = Limit(
    0.5, "1", "difference between the speeds of two pieces that are joined, in resolutions: "
    "pieces that a break separates differ by at least one", _TRICKY,
)  # fmt: skip
MIN_PLATEAUS_OVER_BUMP = Limit(
    20.0, "1", "ratio of the length of two plateaus to that of the disturbance between them that "
    "is bridged", _TRICKY,
)  # fmt: skip
MAX_RESOLUTIONS_ACROSS_BUMP = Limit(
    2.0, "1", "resolutions within which the speeds on both sides of such a disturbance are equal",
    _TRICKY,
)  # fmt: skip
MIN_ERRORS_OF_UNPROVEN = Limit(
    3.0, "1", "standard errors of the change of speed that must fit into the allowed drift; "
    "otherwise a short plateau becomes a ramp", _TRICKY,
)  # fmt: skip
MIN_NEIGHBOUR_OVER_SHORT = Limit(
    4.0, "1", "ratio of the lengths of a neighbouring piece and of a piece, above which the "
    "piece is short", _TRICKY,
)  # fmt: skip
MIN_RAMP_OVER_SPECK = Limit(
    10.0, "1", "ratio of the lengths of a ramp and an adjacent plateau, above which the plateau "
    "belongs to the ramp", _TRICKY,
)  # fmt: skip
MAX_DRIFTS_OF_TRANSIENT = Limit(
    2.0, "1", "allowed drifts between the speeds of a transient and of the plateau it leads to",
    _TRICKY,
)  # fmt: skip
MIN_CHANGE_OF_TRANSIENT = Limit(
    0.5, "1", "ratio of the change along a transient to its difference from the plateau that "
    "follows", _TRICKY,
)  # fmt: skip
MIN_SPIKE_OVER_NOISE = Limit(
    6.0, "1", "noise levels by which a single velocity deviates from its neighbours' median",
    _TRICKY,
)  # fmt: skip
MIN_RELATIVE_SPIKE = Limit(1e-3, "1", "share of the speed below which a spike is ignored", _TRICKY)
MIN_SCATTER_OF_UNSIGNED_NOISE = Limit(
    0.6, "1", "ratio of scatter to mean of a velocity that is noise without its sign",
    "half-normal distribution: 0.76",
)  # fmt: skip
MAX_SMALL_OF_UNSIGNED_NOISE = Limit(
    0.3, "1", "share of the mean below which a reading of such noise is small",
    "half-normal distribution: 0.19 of the readings lie below",
)  # fmt: skip
MIN_SHARE_OF_SMALL = Limit(
    0.1, "1", "share of small readings in noise without its sign",
    "half-normal distribution: 0.19",
)  # fmt: skip
MIN_LOAD_STEP = Limit(
    0.15, "1", "step divided by the larger load; a smaller one is a slow change of the load",
    _TRICKY,
)  # fmt: skip
MAX_SCATTER_OF_LEVEL = Limit(
    0.05, "1", "relative deviation from a load level within which the load stays there", _TRICKY
)
MIN_BINS_OF_LEVEL = Count(5, "1", "bins of a load level, of the 600 of a stretch", _TRICKY)
MAX_LOAD_LEVELS = Count(
    12, "1", "different load levels; a load with more is not a programme of steps", _TRICKY
)
MIN_TIME_AT_LEVELS = Limit(
    0.8, "1", "share of a stretch that the load spends at one of its levels", _TRICKY
)
MIN_LOAD_OF_CONTACT = Limit(
    0.02, "1", "share of the run's load below which there is no contact, if no rest shows the zero"
)
MIN_LOAD_OF_LOADED = Limit(
    0.9, "1", "share of a stretch's load from which the load is fully applied"
)
MAX_LOST_CONTACT = Limit(0.05, "1", "share of a segment without contact that stays in its mean")
MAX_CONTACT_LOSSES = Count(
    5, "1", "losses of contact in a stretch; a load that is lost more often bounces"
)
MIN_SPEED_OVER_TOP = Limit(
    1e-7, "1", "share of the highest speed below which motion is rest: the resolution of a "
    "recorded speed",
)  # fmt: skip
MAX_CREEP_SPEED = Limit(
    1e-5, "1", "share of the highest speed up to which a piece slides only if it covers some "
    "distance",
)  # fmt: skip
MIN_DISTANCE_OF_CREEP = Limit(
    0.01, "1", "distance of such a slow piece divided by the longest distance of a piece",
)  # fmt: skip
MAX_SPEED_OF_NOISE = Limit(
    0.02, "1", "share of the highest speed up to which a velocity may be noise"
)
MIN_SAMPLES_OF_UNSIGNED_NOISE = Count(
    20, "1", "samples that show whether a velocity is noise without its sign"
)
MAX_RAMP_OVER_PLATEAU = Limit(
    1.5, "1", "ratio of the durations of a ramp and the plateau next to it, above which the data "
    "must show that the plateau is distinct", _TRICKY,
)  # fmt: skip
MIN_INTERVALS_OF_PAUSE = Limit(
    20.0, "1", "usual sampling intervals of a pause in which nothing was recorded"
)
MIN_RAMP_OVER_PAUSE = Limit(
    3.0, "1", "ratio of the duration of a ramp to that of a pause in it, above which it is one "
    "ramp",
)  # fmt: skip
MIN_ERRORS_FROM_REST = Limit(
    8.0, "1", "standard errors between a piece's speed and rest: as breaks select the pieces, "
    "chance alone reaches six", _TRICKY,
)  # fmt: skip
MIN_ERRORS_OF_BREAK = Limit(
    6.0, "1", "standard errors between neighbouring windows that make a break", _TRICKY
)
MIN_SHARE_OF_SPEED_CLASS = Limit(
    0.02, "1", "share of the blocks from which a speed has a noise estimate of its own", _TRICKY
)
MAX_COST_OF_MERGER = Limit(
    16.0, "1", "sum of squares, in variances, by which one line may fit worse than two", _TRICKY
)
MIN_SAMPLES_OF_COMMAND = Count(
    20, "1", "samples for which a commanded speed is constant, on average"
)
MIN_DIGITS_OF_COMMAND = Limit(
    2.0, "1", "digits of a rounded reading by which a commanded speed jumps"
)
MIN_OUTLIER = Limit(
    8.0, "1", "usual distances from the median of the neighbours, from which a reading is an "
    "outlier", _TRICKY,
)  # fmt: skip
MIN_GAIN_OF_LEVEL = Limit(
    10.0, "1", "difference of Schwarz's criterion by which a plateau fits better than a smooth "
    "motion: very strong evidence", "Kass and Raftery 1995, doi:10.1080/01621459.1995.10476572",
)  # fmt: skip
MIN_ERRORS_WITHIN_DRIFT = Limit(
    2.0, "1", "standard errors of a change of speed that lie within the allowed drift", _TRICKY
)
MIN_ERRORS_OF_CHANGE = Limit(
    4.0, "1", "standard errors by which the speed of a plateau surely changes", _TRICKY
)
MAX_ERROR_OF_SLOPE = Limit(
    0.03, "1", "relative error of a block's speed that the size of blocks is chosen for", _STROKES
)
MIN_SAMPLES_OF_BLOCK = Count(8, "1", "samples in a block whose slope is its speed", _STROKES)
MIN_JUMP = Limit(
    0.002, "1", "jump divided by the range of the position; a smaller one does not move a "
    "segment's ends", _STROKES,
)  # fmt: skip
MIN_DIGITS_OF_JUMP = Limit(
    2.5, "1", "digits of a jump: a coarse encoder advances by one or two at once", _STROKES
)
MIN_RATE_OF_JUMP = Limit(
    3.0, "1", "ratio of the rate of a jump to the rate around it", _STROKES,
)  # fmt: skip
MIN_SCATTER_OF_JUMP = Limit(
    20.0, "1", "ratio of the rate of a jump to the scatter of the rates around it", _STROKES,
)  # fmt: skip
MAX_UNEQUAL_STEPS = Limit(
    0.02, "1", "share of a calculated motion's steps that differ from the usual one, at its ends",
    _STROKES,
)  # fmt: skip
MAX_NOISE_OF_ROUNDING = Limit(
    0.5, "1", "noise in digits, up to which it is that of rounding", _STROKES
)
MIN_DISTANCE_OVER_NOISE = Limit(
    3.0, "1", "standard deviations of a position reading that a sliding piece covers", _STROKES
)
MIN_SPEED_OVER_ERROR = Limit(
    10.0, "1", "ratio of speed to the error of a block's speed, above which blocks are long "
    "enough", _STROKES,
)  # fmt: skip
MIN_SPEED_OF_STROKE = Limit(0.2, "1", "share of the usual speed; slower motion has no direction")
MIN_LENGTH_OF_STROKE = Limit(0.5, "1", "share of the usual length of a stroke")
MIN_WHOLE_STROKES = Count(
    3, "1", "whole strokes of a reciprocating motion, without the incomplete ones at both ends"
)
MIN_PAUSE_OF_STROKE = Limit(
    0.25, "1", "share of a stroke's duration without a sample, from which the stroke is not used"
)
MIN_EQUAL_STROKES = Count(6, "1", "strokes, nearly all equal, that show a reciprocating motion")
MAX_UNEQUAL_STROKES = Limit(
    0.2, "1", "share of strokes that differ from the others in a reciprocating motion"
)
MAX_CHANGE_OF_DURATION = Limit(
    0.1, "1", "difference of ln duration between successive strokes that are equal"
)
MIN_SAMPLES_OF_STROKE = Count(10, "1", "samples of a stroke")
MIN_ERRORS_BETWEEN_WAYS = Limit(
    5.0, "1", "standard errors by which both directions of an offset velocity differ"
)
MIN_RETURN_OF_TURN = Limit(
    0.25, "1", "share of the range by which a position returns at a turn", _STROKES
)
MIN_STROKES_OF_STRETCH = Count(
    3, "1", "strokes in a stretch that is divided into strokes", _STROKES
)
INNER_PART_OF_STROKE = Limit(
    0.8, "1", "share of a stroke without its ends, where it turns and starts", _STROKES
)
MIN_STRAIGHT_STROKES = Limit(
    0.6, "1", "share of a stretch's strokes that have a constant speed", _STROKES
)
MIN_ERRORS_OF_SLOPE = Limit(
    3.0, "1", "standard errors of a stroke's speed, and of a departure from its straight line",
    _STROKES,
)  # fmt: skip
MAX_DEPARTURE_FROM_LINE = Limit(
    0.005, "1", "share of a stroke by which a position departs from its straight line", _STROKES
)
MAX_SPEED_DIFFERENCE_OF_PLATEAU = Limit(
    0.1, "1", "share of a stroke's speed by which a plateau within it may differ", _STROKES
)
MIN_COVERED_STROKE = Limit(
    0.6, "1", "share of a stroke that plateaus must cover for the stroke to count as found",
    _STROKES,
)  # fmt: skip
MIN_STROKE_OVER_NOISE = Limit(
    20.0, "1", "ratio of the length of a stroke to the noise of a position reading", _STROKES,
)  # fmt: skip
RAMP_SHARE = Limit(
    0.8, "1", "share of a record with rising or falling speed: it is a test by ramps", "judgement"
)
