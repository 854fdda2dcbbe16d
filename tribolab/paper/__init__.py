"""Reproduction of the reference paper: figures, comparison of numbers, and a web page."""
