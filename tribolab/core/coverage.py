"""Coverage of an expanded uncertainty: 95 %, everywhere."""

NORMAL = 1.959963984540054  # standard errors in U95 of a normal distribution
