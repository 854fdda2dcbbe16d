"""Figures of rough surfaces and of their contact."""
