"""Basic tools that all rooms use."""
