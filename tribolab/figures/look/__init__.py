"""Drawing with matplotlib: style, layout, axes, ticks, and controls in notebooks."""
