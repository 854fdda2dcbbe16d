"""Limits for missing heights and plausible sizes of a scan, with reasons."""

from tribolab.core.limit import Limit

MIN_DISTANCE_OF_MARK = Limit(
    1.0, "1", "distance of a repeated exact height from the nearest other one, divided by the "
    "range of all others, above which it means no data; steps and pores leave no such gap",
)  # fmt: skip
MIN_DISTANCE_OF_SINGLE_MARK = Limit(
    5.0, "1", "the same for a single round number; a deep scratch or a high grain is a few ranges "
    "away", "the mark of ../shared/data/nanovea_dropout_MIT/test4.txt lies 5.5 away",
)  # fmt: skip
MAX_DIGITS_OF_MARK = Limit(
    3.0, "1", "most digits of a single no-data value that a program chose: -1, -999, -25.4 mm"
)
MAX_SHARE_OF_MARK = Limit(
    0.5, "1", "largest share of heights with a no-data value; above, it is a level of the surface"
)
MIN_OTHER_HEIGHTS = Limit(
    16.0, "1", "fewest different heights besides the no-data value; a scan with fewer is a drawing"
)
SAME_RANGE = Limit(
    1e-3, "1", "largest relative difference between the stated range and that of the heights, "
    "since it is written with few digits", "WSxM writes 'Z Amplitude: 41.20 nm'",
)  # fmt: skip
LARGEST_MAP = Limit(
    10.0, "m", "largest length of a map; gantries with optical gauges reach one metre"
)
FINEST_PITCH = Limit(
    1e-13, "m", "smallest pitch: a tenth of the finest steps of a tunnelling microscope"
)
LARGEST_REACH = Limit(
    100.0, "1", "range of heights, divided by the length of a scan, above which a unit is wrong: "
    "no gauge measures a range of 100 lengths, and wrong units are wrong by 1000",
    "../shared/data/surfacetopography_MIT/gwyddion-export-german.txt: 15 m of height on 12 um",
)  # fmt: skip
DOUBTFUL_REACH = Limit(
    0.05, "1", "range of heights without curvature, divided by the length of a scan, above which "
    "a unit is doubted",
)  # fmt: skip
DOUBTFUL_SLOPE = Limit(
    1.0, "1", "rms slope above which a unit is doubted: 45 degrees all over the surface"
)
MIN_HEIGHTS_OF_LINE = Limit(16.0, "heights", "fewest heights of a line whose unit is judged")
LONGEST_PROBE_SCAN = Limit(2e-4, "m", "longest line of a probe microscope")
FINEST_LONG_REACH = Limit(
    1e-8, "m", "smallest range of heights on longer lines, which a stylus measures: its residual "
    "profile is no finer", "ISO 3274 and data sheets of stylus instruments: some 10 nm",
)  # fmt: skip
