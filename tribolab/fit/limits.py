"""Limits for conclusions from fits of models to friction."""

from tribolab.core.limit import Count, Limit

_SHEAR = "tests/coverage/shear_stress_coverage.py"
_JOINT = "judgement; coverage checked by tests/coverage/joint_fit_coverage.py"

MIN_SPEEDS_OF_BAND = Count(
    4, "1", "measured speeds within the calculated band; with fewer, the band's own speeds are "
    "added",
)  # fmt: skip
MIN_LN_ODDS = Limit(
    1.0, "1", "ln(Bayes factor) below which no model is preferred",
    "Kass and Raftery 1995, doi:10.1080/01621459.1995.10476572",
)  # fmt: skip
STRONG_LN_ODDS = Limit(
    3.0, "1", "ln(Bayes factor) above which a model is strongly preferred",
    "Kass and Raftery 1995, doi:10.1080/01621459.1995.10476572",
)  # fmt: skip
PRIOR_FREEDOM_OF_SCATTER = Limit(
    4.0, "1", "degrees of freedom with which the pooled scatter enters the scatter at one speed",
    _JOINT,
)  # fmt: skip
MIN_POINTS_OF_LOAD = Count(
    4, "1", "points of positive friction in a joint fit, and points whose scatter is pooled"
)
MIN_SPEEDS_OF_RESPONSE = Count(5, "1", "computed speeds of a curve that is interpolated")
MAX_SPACING_OF_RESPONSE = Limit(
    1.0, "1", "largest spacing of computed points in ln(viscosity x speed); across wider gaps a "
    "spline may be off by several percent",
)  # fmt: skip
MIN_REDUCTION_OF_PRIOR = Limit(
    0.2, "1", "reduction of the prior's standard deviation by the data, below which a parameter "
    "is not identified", _JOINT,
)  # fmt: skip
WEAK_REDUCTION_OF_PRIOR = Limit(0.5, "1", "reduction below which it is weakly identified", _JOINT)
MAX_CORRELATION = Limit(0.8, "1", "correlation above which two parameters are hardly distinct")
MAX_CORRELATED_ERROR = Limit(
    0.09, "1", "relative error that neighbouring speeds share, above which the model does not "
    "describe the curves", _JOINT,
)  # fmt: skip
LOAD_CHANGE_BY_TILT = Limit(
    0.1, "1", "relative change of the load at the ends of a line, for which the tilt is stated"
)
PRIOR_OF_STATED_ERRORS = Limit(
    0.9, "1", "prior probability that the stated errors of points are right", _SHEAR
)
PRIOR_RATIO_OF_GROWTH = Limit(
    0.85, "1", "ratio of the prior probabilities of successive factors (of 1.35) by which errors "
    "are too small", _SHEAR,
)  # fmt: skip
MIN_CHANCE_OF_MISFIT = Limit(
    0.01, "1", "probability of chi-square above which the model describes a range of speeds"
)
MIN_SPEEDS_OF_RANGE = Count(4, "1", "speeds in such a range")
MAX_FREEDOM_TO_REPORT = Count(30, "1", "degrees of freedom below which Student's t is mentioned")
MIN_ERROR_OF_HURST = Limit(
    0.1, "1", "error of the Hurst exponent of the extrapolation: a spectrum need not be one power "
    "law",
)  # fmt: skip
MAX_CELLS_OF_CHANGE = Count(
    100, "1", "cells of the mesh if only the change of a curve is computed: the mesh error "
    "cancels",
)  # fmt: skip
