"""Long arrays: medians, chunks, scratch files, and functions over several runs at once."""
