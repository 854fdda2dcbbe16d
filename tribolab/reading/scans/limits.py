"""Limits for missing heights and plausible sizes of a scan, with reasons."""

from tribolab.core.limit import Limit

MIN_DISTANCE_OF_MARK = Limit(
    1.0,
    "1",
    "distance to the nearest other height over the range of all others, from which on a height "
    "that is repeated exactly means no data: steps and pores are no such gap",
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
    16.0, "1", "different heights besides the mark: a scan of fewer is a drawing", "judgement"
)
SAME_RANGE = Limit(
    1e-3,
    "1",
    "a stated range is that of the heights within so much of itself: it is written with few digits",
    "WSxM writes 'Z Amplitude: 41.20 nm'",
)
LARGEST_MAP = Limit(10.0, "m", "gantries with optical gauges reach one", "judgement")
FINEST_PITCH = Limit(
    1e-13, "m", "a tenth of the finest steps of a tunnelling microscope", "judgement"
)
LARGEST_REACH = Limit(
    100.0,
    "1",
    "heights over the length of a scan: gauges that measure a range of 100 lengths are not made, "
    "a unit that is wrong is so by 1000",
    "../shared/data/surfacetopography_MIT/gwyddion-export-german.txt: 15 m of height on 12 um",
)
DOUBTFUL_REACH = Limit(
    0.05,
    "1",
    "heights over the length, the bow taken off, from which a unit is doubted",
    "judgement",
)
DOUBTFUL_SLOPE = Limit(1.0, "1", "rms slope: 45 deg all over the surface", "judgement")
MIN_HEIGHTS_OF_LINE = Limit(16.0, "heights", "of a line that is judged", "judgement")
LONGEST_PROBE_SCAN = Limit(
    2e-4, "m", "no probe microscope scans a longer line than 0.2 mm", "judgement"
)
FINEST_LONG_REACH = Limit(
    1e-8,
    "m",
    "heights of longer lines are a stylus's: its residual profile is no finer",
    "ISO 3274 and data sheets of stylus instruments: some 10 nm",
)
