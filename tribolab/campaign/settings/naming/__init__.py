"""Names in a campaign file: of runs, of files, and what a pattern reads from them."""
