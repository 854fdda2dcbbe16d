"""The virtual rig: raw files like a lab's, with the truth beside them."""
