"""Limits for grouping speeds, combining repeats, and finding outlying repeats."""

from tribolab.core.limit import Count, Limit

_GROUPS = "tests/coverage/points_coverage.py groups, seed 1; reported on seed 101"
_MEANS = "tests/coverage/points_coverage.py means, seed 4; reported on seed 104"
_ODD = "tests/coverage/points_coverage.py odd, seed 5; reported on seed 105"

SPEED_TOLERANCE = Limit(
    0.1, "1", "largest relative difference of the speeds of one point", "judgement"
)
SPEED_FLOOR = Limit(
    5e-3, "1", "relative difference of speed due to drive and recording alone", _GROUPS,
)  # fmt: skip
CLEAR_JUMP = Limit(
    2.0, "1", "ratio of the gaps between groups to those within them, above which the groups are "
    "distinct", _GROUPS,
)  # fmt: skip
FAIR_JUMP = Limit(1.4, "1", "the same ratio, below which the groups are not told apart", _GROUPS)
NARROW_GAP = Limit(
    0.5, "1", "ratio of a gap to the width of the wider group; a narrower gap does not separate "
    "groups", _GROUPS,
)  # fmt: skip
NARROW_GAPS = Limit(
    0.02, "1", "largest accepted share of narrow gaps", _GROUPS,
)  # fmt: skip
SWEEP_STEPS = Limit(
    5.0, "1", "least steps of a run whose speed only rises or only falls, so that no speed "
    "repeats", "judgement",
)  # fmt: skip
UNEQUAL_ERRORS = Limit(
    5.0, "1", "ratio of the largest to the smallest error, up to which the plain mean is better",
    _MEANS,
)  # fmt: skip
POOLED_DOF = Limit(
    4.0, "1", "fewest degrees of freedom of the scatter at other speeds for it to be used", _MEANS,
)  # fmt: skip
PRIOR_WIDTH = Limit(
    1.5, "1", "scale of the prior of the scatter, divided by the pooled scatter", _MEANS,
)  # fmt: skip
ODD_BY_CHANCE = Limit(0.01, "1", "chance per campaign that sound repeats are called odd", _ODD)
SUSPECT_BY_CHANCE = Limit(0.05, "1", "the same for a repeat that is suspect", _ODD)
UNEVEN_SCATTER = Limit(
    0.3, "1", "standard deviation of ln(scatter) between conditions that are alike", "judgement"
)
TRIMMED = Limit(0.2, "1", "share of the largest contrasts that do not count as repeatability", _ODD)
MIN_CONTRASTS_TO_TRIM = Count(
    5, "1", "fewest contrasts of which the largest are omitted", _ODD,
)  # fmt: skip
MIN_STROKES_OF_MEMORY = Count(
    24, "1", "strokes of one speed whose order shows how long friction is correlated"
)
