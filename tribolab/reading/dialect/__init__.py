"""Dialects: description of an instrument's raw files and their columns as data."""
