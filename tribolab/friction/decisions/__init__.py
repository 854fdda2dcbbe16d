"""Decisions of a person on runs and segments."""
