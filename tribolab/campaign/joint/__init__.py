"""Joint fits of a campaign: all loads of a surface in one liquid, or of several surfaces."""
