"""Simulated roughness scans, with and without faults."""
