"""Report page: its sections, key numbers and texts."""
