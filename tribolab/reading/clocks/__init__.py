"""Clock of a run, and alignment of two clocks."""
