"""The reference paper reproduced: its figures, its numbers beside computed ones, and a page."""
