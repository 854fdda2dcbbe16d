"""The page report.html: its sections, key numbers and texts."""
