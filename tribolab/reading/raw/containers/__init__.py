"""One file a container: what holds columns by name, read as tables of arrays."""
