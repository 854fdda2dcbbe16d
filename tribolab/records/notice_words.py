"""How the notices of a run begin that the terminal and the page's first lines pick out."""

from __future__ import annotations

OUTSIDE = "what lies outside "  # of strokes of which a part counts
NOT_NEEDED = "left out, as no result needs them"  # columns whose unit or name is in doubt
RIG_STIFFNESS = "stiffness of the rig"
STEPS_DIFFER = "friction at one speed differs from step to step"
TRENDS = ("friction rises along", "friction falls along")
