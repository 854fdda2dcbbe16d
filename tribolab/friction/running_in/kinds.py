"""Kinds of running-in, and of the intervals that friction is averaged over."""

CYCLES, STROKES, STRETCHES = "cycles", "strokes", "stretches"
NONE, RUN_IN, STEP, NOT_FINISHED = "none", "running-in", "step", "not finished"
