"""Figures: one description per subject, drawn for papers and for the page."""
