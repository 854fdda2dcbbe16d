"""Units, the register of quantities, and the stamp that every array carries."""
