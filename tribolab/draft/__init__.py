"""A dialect drafted from an unknown raw file."""
