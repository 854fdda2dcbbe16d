"""Readers of file formats with named columns, one per module."""
