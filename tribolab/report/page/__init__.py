"""The page: its sections, its answer, its words."""
