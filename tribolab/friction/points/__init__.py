"""Points of a curve from strokes: grouping of speeds, and means."""
