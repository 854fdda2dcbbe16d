"""Functions that describe the figures, one module per subject."""
