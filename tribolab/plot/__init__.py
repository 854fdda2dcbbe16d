"""Figures: one function per figure, a result in, a matplotlib Figure out."""
