"""Figures: one description per subject, drawn for publications and for the page."""
