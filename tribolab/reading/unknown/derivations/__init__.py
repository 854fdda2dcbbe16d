"""Quantities that follow from columns and stated amounts."""
