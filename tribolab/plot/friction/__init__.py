"""Figures of friction over speed."""
