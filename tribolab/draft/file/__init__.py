"""How an unknown file is written: its lines, its header, its tables."""
