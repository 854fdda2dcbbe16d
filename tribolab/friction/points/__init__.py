"""From strokes to the points of a curve: which speeds are one, and what their mean is."""
