"""Surfaces of a campaign: scans, spectrum, roughness, contact and adhesion."""
