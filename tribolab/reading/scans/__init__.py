"""Scans without a dialect: profiles and maps of heights."""
