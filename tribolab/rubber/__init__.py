"""Rubber: viscoelastic modulus and hysteresis friction on rough surfaces."""
