"""Units, the list of all quantities, and the metadata of arrays."""
