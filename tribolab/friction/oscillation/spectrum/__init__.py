"""Spectrum of a record: lines, mains hum, and significance above noise."""
