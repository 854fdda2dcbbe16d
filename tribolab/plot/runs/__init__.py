"""Figures of one run: its trace, its strokes, the start of sliding."""
