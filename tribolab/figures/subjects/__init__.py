"""Descriptions of the figures: one module per subject."""
