"""Limits for the determination of the zeros of the forces."""

from tribolab.core.limit import Count, Limit

_TRICKY = "tests/detection/tricky_runs.py, seeds 0 to 9; reported on seeds from 1000"
MAX_SAMPLE_TILT = Limit(
    0.09, "rad", "largest tilt between force cell and contact that is believed: five degrees; a "
    "sample that is askew by more is seen with the bare eye",
)  # fmt: skip
TILT_CHANGES = Limit(
    0.5, "1", "relative change of the loops' middle along a run, above which it drifts: a tilt "
    "does not change with time",
)  # fmt: skip
LOADS_DIFFER = Limit(
    1.2, "1", "ratio of the largest to the smallest load, above which a tilt can be "
    "distinguished from a zero",
)  # fmt: skip
UNLOADED_NOISE = Limit(
    3.0, "1", "standard deviations of the unloaded reading within which another rest is unloaded"
)
UNLOADED_SHARE = Limit(
    3e-3, "1", "share of the load by which unloaded rests differ: creep and friction in the cell",
    "data sheets of strain-gauge cells: 0.02 to 0.3 %",
)  # fmt: skip
DOUBTFUL_REST = Limit(
    0.01, "1", "difference between the readings of a rest and of the unloaded rest, divided by "
    "the load, above which the run is doubted: a smaller one is within the error of the load",
    "judgement",
)  # fmt: skip
DRIFT_IN_STROKES = Limit(
    0.5, "1", "share of the scatter of the strokes' load that may remain once the readings at rest "
    "are taken off, if these are a drift of the cell's zero",
)  # fmt: skip
LOADED_REST_SHARE = Limit(
    0.02, "1", "share of friction by which a loaded rest before any sliding may differ from an "
    "unloaded one; more is a tilt or the cross-talk of the load",
)  # fmt: skip
DRAG_SHARE = Limit(
    0.02, "1", "drag without load divided by friction, above which it is reported",
)  # fmt: skip
NOISE_PASSES = Limit(
    0.1, "1", "chance that noise at a turn is mistaken for readings during the transition "
    "between the levels",
)  # fmt: skip
LOAD_AT_REST = Limit(
    0.03, "1", "share of the load by which the reading may change between rest and sliding: above "
    "it friction leaks into the reading, or the load is not controlled; below it the error of the "
    "load includes the change", "as for the change of a load along a run",
)  # fmt: skip
SAME_LOAD = Limit(
    1.25, "1", "ratio of the loads at rest and while sliding that were meant to be one"
)
FRICTION_RELEASED = Limit(
    0.25, "1", "share of the friction that a loaded rest must have lost to show whether friction "
    "leaks into the load reading: with less the noise of the reading is amplified too much",
)  # fmt: skip
MIN_SAMPLES_OF_LOADED_REST = Count(20, "1", "samples of a loaded rest")
MIN_ERRORS_OF_READINGS = Limit(
    4.0, "1", "standard errors between two readings that differ, at rest or with load", _TRICKY
)
MAX_SLOPE_OF_DRIFT = Limit(
    2.0, "1", "ratio of the slope of a drift of the zero to that between the next loops; a "
    "steeper change is a jump", _TRICKY,
)  # fmt: skip
MAX_SPEED_DIFFERENCE_OF_PAIR = Limit(
    0.25, "1", "relative difference of speed up to which two strokes make a pair"
)
MIN_ERRORS_OF_LEVEL = Limit(
    5.0, "1", "standard errors by which a level must differ from zero, or from another level",
    _TRICKY,
)  # fmt: skip
MAX_MIDDLE_OF_SIGNED_LOOP = Limit(
    0.3, "1", "ratio of the offset to the half loop, below which the force has its sign", _TRICKY,
)  # fmt: skip
MIN_LEVEL_RATIO_OF_LOST_SIGN = Limit(
    0.5, "1", "ratio of the smaller to the larger level of two strokes whose sign was lost",
    _TRICKY,
)  # fmt: skip
MAX_FRICTION_RATIO_OF_PARTS = Limit(
    4.0, "1", "ratio of friction between parts of a run that measure the same friction", _TRICKY
)
MAX_LEVEL_OF_DIP = Limit(
    0.5, "1", "share of the strokes' level, below which the force at a reversal passes through "
    "zero", _TRICKY,
)  # fmt: skip
MAX_ERRORS_OF_TOUCH = Limit(
    5.0, "1", "standard deviations from zero within which the force touches it", _TRICKY
)
MIN_DEPTH_OF_DIP = Limit(
    1.0, "1", "depth of a reading below the lower stroke, in standard deviations of the stroke, "
    "from which it is on its way through zero", _TRICKY,
)  # fmt: skip
MAX_READINGS_OF_DIP = Count(
    3, "1", "readings at such a depth; with more of them, one would have been close to zero",
    _TRICKY,
)  # fmt: skip
MIN_READINGS_BETWEEN_LEVELS = Count(
    3, "1", "readings between two levels; noise does not cause so many at the majority of the "
    "reversals", _TRICKY,
)  # fmt: skip
MAX_REVERSALS_WITH_SPIKE = Limit(
    0.1, "1", "share of reversals at which a spike or a slip is below both levels", _TRICKY
)
MIN_REVERSALS_WITH_DIP = Limit(0.5, "1", "share of reversals that show the same", _TRICKY)
MAX_DIFFERENCE_OF_LEVELS = Limit(
    0.25, "1", "relative difference of the levels of both directions, if they are one level",
    _TRICKY,
)  # fmt: skip
MAX_SPEED_DIFFERENCE_OF_REVERSAL = Limit(
    0.2, "1", "relative difference of the speeds before and after a reversal", _TRICKY
)
MAX_ASYMMETRY = Limit(
    0.05, "1", "share of friction by which a stated zero may differ from the middle of the loop",
    _TRICKY,
)  # fmt: skip
MIN_ERRORS_OF_ASYMMETRY = Limit(3.0, "1", "standard errors of the same", _TRICKY)
EXAMPLE_OF_ZERO_ERROR = Limit(
    0.02, "1", "share of friction that a message suggests as the uncertainty of the zero"
)
MAX_DRIFT_OF_LOAD_ZERO = Limit(
    0.1, "1", "share of the load by which the zero of the normal force may change between rests"
)
MAX_LOAD_OF_BARE_REST = Limit(
    0.4, "1", "share of the load below which a rest may be one without contact"
)
MAX_RATIO_TO_REST = Limit(
    1.5, "1", "ratio of the load of a segment to the reading at a rest, below which the segment "
    "slides at the load of the rest", _TRICKY,
)  # fmt: skip
MIN_SAMPLES_OF_REST = Count(10, "1", "samples of an unloaded rest")
MAX_SCATTER_OF_BARE_REST = Limit(
    0.02, "1", "share of the load within which the reading stays without contact"
)
MAX_SPEED_DIFFERENCE_OF_LOOP = Limit(
    0.05, "1", "relative difference of speed up to which both strokes measure friction at one speed"
)
SPEED_DEPENDENCE = Limit(
    0.15, "1", "share of friction by which it changes when the speed changes by a factor of e, if "
    "not measured",
)  # fmt: skip
MIN_SPEED_DEPENDENCE = Limit(0.05, "1", "the same if a smaller one was measured")
MAX_SPEED_RATIO_OF_LOOP = Limit(
    1.0, "1", "relative difference of the speeds of a loop's strokes, unless both are stated to "
    "be a loop",
)  # fmt: skip
MIN_LOAD_OF_REST = Limit(0.8, "1", "share of the load from which a rest is loaded")
