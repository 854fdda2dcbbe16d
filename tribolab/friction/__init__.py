"""What the friction signals say: segments, friction coefficients, measured curves."""
