"""What the notices of a run are about, as the terminal and the page's first lines pick them out."""

from __future__ import annotations

STROKE_ENDS = "stroke ends"  # parts of strokes that do not count
DOUBTFUL_COLUMNS = "doubtful columns"  # whose unit or name is in doubt
STICK_SLIP = "stick-slip"  # the stiffness of the rig beside the critical one
STEPS = "steps"  # friction that differs from step to step
RUNNING_IN = "running-in"  # or wear
CHANGES = (RUNNING_IN, STEPS)
