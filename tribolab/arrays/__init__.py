"""Tools for long arrays: medians, processing in pieces, scratch files; functions of lists."""
