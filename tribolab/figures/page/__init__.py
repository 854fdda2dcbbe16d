"""Figures on the report page: initial view, and the picture shown until the script has drawn it."""
