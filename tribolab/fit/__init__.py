"""Measured curves held against computed ones."""
