"""Campaigns: the typed campaign file and the pipeline over its runs."""
