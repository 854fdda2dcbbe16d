"""Zero of the friction force: its source, and doubts about it."""
