"""Bytes of a file become tables, and tables become runs and scans in SI units."""
