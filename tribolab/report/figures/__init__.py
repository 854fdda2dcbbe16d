"""Figures for papers: drawn by workers, kept while what they show is the same."""
