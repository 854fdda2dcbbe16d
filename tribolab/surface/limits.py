"""Limits that decide how spectra of surfaces are evaluated, with their reasons."""

from tribolab.core.limit import Limit

MIN_INDEPENDENT_VALUES = Limit(
    1e-3, "1", "with fewer values, a spectral value is uncertain by thirty decades, so that no "
    "band is given", "judgement",
)  # fmt: skip
MIN_WAVES_OF_MAP = Limit(
    4.0,
    "1",
    "form and window take the two longest waves; of fewer than four none is left for a spectrum",
    "judgement",
)
MIN_HURST = Limit(
    0.0, "1", "below it, the extrapolated waves would contribute unbounded height",
    "self-affine surfaces have 0 to 1, doi:10.1016/j.apsadv.2021.100190",
)  # fmt: skip
MAX_SURE_HURST = Limit(
    1.25, "1", "exponent that a surface may exceed only within the error of the fit; worn, "
    "polished and moulded surfaces have steeper spectra than a self-affine one (1.09 to 1.19 in "
    "the study xu2026), and add little slope where they are extrapolated", "judgement",
)  # fmt: skip
MAX_FITTED_HURST = Limit(
    2.0, "1", "fits of tips and filters reach 1.5; a steeper one is not believed", "judgement"
)
MIN_SHARE_OF_HEIGHT = Limit(
    0.9, "1", "ratio of the rms height of the measured waves to Pq; if more than a tenth is "
    "missing, it is stated", "judgement",
)  # fmt: skip
MAX_EXTRAPOLATED_SLOPE = Limit(
    1.0,
    "1",
    "rms slope; theories of contact take small slopes, and surfaces are measured with 0.001 to 1",
    "judgement",
)
