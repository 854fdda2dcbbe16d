"""What each figure shows: a module per subject."""
