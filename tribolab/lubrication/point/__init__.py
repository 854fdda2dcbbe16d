"""Mixed lubrication of a ball on a flat (point contact)."""
