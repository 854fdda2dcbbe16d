"""Joint fits in one liquid: all loads of a surface, or several surfaces together."""
