"""Readers of profile and map formats, one per module."""
