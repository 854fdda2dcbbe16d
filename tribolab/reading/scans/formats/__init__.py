"""Formats of profiles and maps, one module for each."""
