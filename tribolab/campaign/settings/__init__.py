"""Settings that the user writes: the campaign file and the review file."""
