"""Friction coefficients with their uncertainty."""
