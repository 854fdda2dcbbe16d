"""What the user writes: the campaign file and the review file, read, checked and planned."""
