"""Profiles and maps of heights."""
