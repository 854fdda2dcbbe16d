"""Stick-slip and other oscillation of friction."""
