"""Checks on scans of a surface."""
