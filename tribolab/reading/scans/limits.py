"""Numbers that decide which heights of a scan are none, with their reasons."""

from tribolab.core.limit import Limit

MIN_DISTANCE_OF_MARK = Limit(
    1.0,
    "1",
    "distance to the nearest other height over the range of all others, from which on a height "
    "that is repeated exactly stands for no data: steps and pores are no such gap",
    "judgement",
)
MIN_DISTANCE_OF_SINGLE_MARK = Limit(
    5.0,
    "1",
    "the same for a single round number: a deep scratch or a high grain reaches a few ranges",
    "the mark of ../shared/data/nanovea_dropout_MIT/test4.txt lies 5.5 away",
)
MAX_DIGITS_OF_MARK = Limit(
    3.0, "1", "digits of a single number that a program chose: -1, -999, -25.4 mm", "judgement"
)
MAX_SHARE_OF_MARK = Limit(0.5, "1", "beyond it the number is a level of the surface", "judgement")
MIN_OTHER_HEIGHTS = Limit(
    16.0, "1", "different heights beside the mark: a scan of fewer is a drawing", "judgement"
)
SAME_RANGE = Limit(
    1e-3,
    "1",
    "a stated range is that of the heights within so much of itself: it is written with few digits",
    "WSxM writes 'Z Amplitude: 41.20 nm'",
)
