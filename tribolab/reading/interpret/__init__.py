"""Interpretation of columns and settings: evidence, rules of physics, decision."""
