"""What the text above a table states."""
