"""Figures: described once per subject, then drawn for publications or for the report page."""
