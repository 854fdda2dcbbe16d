"""How a run may become steady, and what its friction is averaged over."""

CYCLES, STROKES, STRETCHES = "cycles", "strokes", "stretches"
NONE, RUN_IN, STEP, NOT_FINISHED = "none", "running-in", "step", "not finished"
