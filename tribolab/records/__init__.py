"""The results of one run, curve, surface or model in a short form, for tables and the page."""
