"""Safe reading of raw files as tables of numbers and texts."""
