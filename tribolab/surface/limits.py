"""Numbers that decide about spectra of surfaces, with their reasons."""

from tribolab.core.limit import Limit

MIN_INDEPENDENT_VALUES = Limit(
    1e-3,
    "1",
    "a spectral value with fewer is known to within thirty powers of ten: a wider band is no band",
    "judgement",
)
MIN_WAVES_OF_MAP = Limit(
    4.0,
    "1",
    "form and window take the two longest waves; of fewer than four none is left for a spectrum",
    "judgement",
)
