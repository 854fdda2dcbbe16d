"""Limits for averaging records, moving mass, run-out and traction curves."""

from __future__ import annotations

from tribolab.core.limit import Count, Limit

MAX_UNEVEN = Limit(
    0.01, "1", "largest deviation of the row times from even spacing, as a share of the "
    "duration: the plain mean is then off by at most two per cent of the change of the signal",
    "|mean by rows - mean by time| <= D x total variation (Koksma's inequality)",
)  # fmt: skip
MIN_GAP = Limit(
    5.0, "1", "an interval that is longer than those around it by this factor is a gap in the "
    "record", "late buffers cause gaps of 2 to 3 intervals",
)  # fmt: skip
MIN_BLOCKS = Count(12, "1", "blocks of the greatest length: their scatter is known within a fifth")
MIN_SPEED_OF_MASS = Limit(
    0.4, "1", "share of the highest speed below which friction still reverses"
)
MAX_EVEN_ACCELERATION = Limit(
    0.3, "1", "ratio of the median to the highest acceleration, below which only ramps accelerate",
)  # fmt: skip
MIN_PAIRS_OF_STROKES = Count(4, "1", "pairs of strokes in a fit of the moving mass")
MIN_SAMPLES_OF_PAIR = Count(24, "1", "samples of such a pair")
MIN_ERRORS_OF_MASS = Limit(5.0, "1", "standard errors of a moving mass that is reported")
MIN_FORCE_OF_MASS = Limit(
    0.02, "1", "inertial force divided by the friction force; a smaller one is ignored",
)  # fmt: skip
MAX_NOISE_OF_ACCELERATION = Limit(
    0.05, "1", "share of the variance of the acceleration that is noise"
)
MAX_ERROR_OF_SPEED = Limit(
    0.01, "1", "relative error of a set speed that is used as the measured one",
    "judgement; checked by tests/coverage/run_out_coverage.py",
)  # fmt: skip
MIN_WAVE_OVER_SPECTRUM = Limit(
    12.0, "1", "ratio of a wave's power to the spectrum next to it, which has a chance of e**-12",
    "judgement; checked by tests/coverage/run_out_coverage.py",
)  # fmt: skip
MAX_RATIO_OF_PURE_ROLLING = Limit(
    0.01, "1", "slide-roll ratio of a pair that rolls: 0.0003 to 0.013 were recorded",
    "shared/data/pcs_mtm_ehd_MIT/demo_12.txt",
)  # fmt: skip
MIN_RATIOS_OF_TRACTION = Count(3, "1", "slide-roll ratios at one speed that make a traction curve")
