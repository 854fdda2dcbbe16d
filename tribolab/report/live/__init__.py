"""Data of the figures that the page draws itself."""
