"""Units, the register of quantities, and the metadata of arrays."""
