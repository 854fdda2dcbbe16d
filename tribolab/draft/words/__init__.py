"""What words in names and texts of strangers mean."""
