"""Figures of the page that the reader can zoom and filter, one module for each subject."""
