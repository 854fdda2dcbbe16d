"""Runs of a campaign: analysis, checks, files and records."""
