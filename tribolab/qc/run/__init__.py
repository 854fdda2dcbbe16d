"""Checks on a run: its reading, its record, its zero, the rig, the sliding."""
