"""Figures on the report page: data for the script, and the picture shown before it runs."""
