"""Instruments as data: how delimited text is read by its dialect."""
