"""Quantity and unit of each column of an unknown table."""
