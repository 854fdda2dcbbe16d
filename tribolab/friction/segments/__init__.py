"""Segments of constant speed and direction, and the strokes they belong to."""
