"""Validity limits of lubricated contacts."""

from tribolab.core.limit import Limit

MAX_VISCOUS_HEATING = Limit(
    2.0, "K", "temperature rise of a liquid by its own shear, which lowers glycerol's viscosity "
    "by a sixth", "Cheng (2008), doi:10.1021/ie071349z",
)  # fmt: skip
