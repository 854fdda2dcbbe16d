"""Comparison of measured curves with computed ones."""
