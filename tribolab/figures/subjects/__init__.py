"""Descriptions of all figures, one module per subject."""
