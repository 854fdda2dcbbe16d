"""Long arrays: medians, chunks, scratch files, and functions on lists of runs."""
