"""Simulated scans of rough surfaces, with and without faults."""
