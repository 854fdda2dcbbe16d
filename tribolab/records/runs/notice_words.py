"""Topics of the notices of a run, used to select them in the terminal and on the page."""

from __future__ import annotations

STROKE_ENDS = "stroke ends"  # parts of strokes that are not used
DOUBTFUL_COLUMNS = "doubtful columns"  # columns with a doubtful unit or name
STICK_SLIP = "stick-slip"  # stiffness of the rig compared with the critical one
STEPS = "steps"  # friction that differs between steps
LEFT_OUT = "left out"  # rests, ramps and short stretches
RUNNING_IN = "running-in"  # or wear
CHANGES = (RUNNING_IN, STEPS)
