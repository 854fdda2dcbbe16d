"""Points of a measured curve: grouping of strokes by speed, and their means."""
