"""Uncertainty of results: budget, repeatability, control charts, comparison, planning."""
