"""Scans that no dialect describes: profiles and maps of heights."""
