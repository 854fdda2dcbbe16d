"""Checks on a run: file, record, zero, rig and sliding."""
