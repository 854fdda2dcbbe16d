"""Quantities that are derived from columns and stated amounts."""
