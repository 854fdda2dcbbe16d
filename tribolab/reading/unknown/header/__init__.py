"""Settings that the text above a table states."""
