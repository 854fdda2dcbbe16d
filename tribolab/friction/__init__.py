"""Analysis of friction signals: segments, friction coefficients, measured curves."""
