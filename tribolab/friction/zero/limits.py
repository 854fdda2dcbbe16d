"""Numbers that decide what the zero of the forces is."""

from tribolab.core.limit import Limit

MAX_SAMPLE_TILT = Limit(
    0.09, "rad", "largest tilt between force cell and contact that is believed: five degrees; a "
    "sample that is askew by more is seen with the bare eye",
)  # fmt: skip
TILT_CHANGES = Limit(
    0.5, "1", "change of the loops' middle along a run, over its mean, from which on it drifts: a "
    "tilt does not change with time",
)  # fmt: skip
LOADS_DIFFER = Limit(1.2, "1", "largest over smallest load that can tell a tilt from a zero")
UNLOADED_NOISE = Limit(
    3.0, "1", "standard deviations of the unloaded reading within which another rest is unloaded"
)
UNLOADED_SHARE = Limit(
    3e-3, "1", "share of the load by which unloaded rests differ: creep and friction in the cell",
    "data sheets of strain-gauge cells: 0.02 to 0.3 %",
)  # fmt: skip
DOUBTFUL_REST = Limit(
    0.01, "1", "share of the load by which a rest reads more than the unloaded one, from which on "
    "the run is doubted: below it the error of the load holds both readings", "judgement",
)  # fmt: skip
DRIFT_IN_STROKES = Limit(
    0.5, "1", "share of the scatter of the strokes' load that may remain once the readings at rest "
    "are taken off, if these are a drift of the cell's zero",
)  # fmt: skip
LOADED_REST_SHARE = Limit(
    0.02, "1", "share of friction by which a loaded rest before any sliding may differ from an "
    "unloaded one; more is a tilt or the cross-talk of the load",
)  # fmt: skip
DRAG_SHARE = Limit(0.02, "1", "share of friction that drag without load may have unreported")
NOISE_PASSES = Limit(
    0.1, "1", "chance that the noise of all readings at a turn passes for one on its way from one "
    "level to the other",
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
