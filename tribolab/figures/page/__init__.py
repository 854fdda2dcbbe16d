"""Figures on the page: what is seen at first, and the picture shown until the script has drawn."""
