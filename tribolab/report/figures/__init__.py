"""Figures for publication: drawn by workers, and reused while their data are unchanged."""
