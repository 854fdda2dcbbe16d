"""Layout of an unknown file: lines, header, tables."""
