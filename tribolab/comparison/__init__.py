"""Comparison of results folders, history of instruments, and planning."""
