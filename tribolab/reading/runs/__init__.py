"""One run in SI units from the tables of its files."""
