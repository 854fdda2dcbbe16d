"""Friction coefficients with their errors."""
