"""Figures on the page: initial view, and the picture shown until the script has drawn."""
