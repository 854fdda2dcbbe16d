"""Reading of delimited text with a dialect, block by block."""
