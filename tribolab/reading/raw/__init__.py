"""Files as they are: opened safely, and returned as tables of numbers and texts."""
