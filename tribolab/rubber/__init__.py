"""Rubber: its viscoelastic modulus and the friction that hysteresis causes on roughness."""
