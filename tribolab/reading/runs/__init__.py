"""Assembly of one run in SI units from the tables of its files."""
