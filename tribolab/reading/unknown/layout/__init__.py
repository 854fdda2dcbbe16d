"""How an unknown file is laid out: lines, header, tables."""
