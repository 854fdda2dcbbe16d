"""Text format before any dialect: encoding, arrangement, cells, numbers."""
