"""Pieces of constant speed: found, and judged."""
