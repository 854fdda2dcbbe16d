"""Simulated scans of rough surfaces, sound and faulty."""
