"""Figures, one description per subject, drawn for publications and for the report page."""
