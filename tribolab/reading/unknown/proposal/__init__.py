"""Draft of a dialect for an unknown file: how it is shown, corrected and written."""
