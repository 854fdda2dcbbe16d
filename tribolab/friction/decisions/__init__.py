"""What a person decided on runs and segments, and what follows from it."""
