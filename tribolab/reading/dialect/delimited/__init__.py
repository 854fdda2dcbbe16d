"""Delimited text read by its dialect, block by block."""
