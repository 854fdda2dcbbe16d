"""Running-in of friction, and its steady value."""
