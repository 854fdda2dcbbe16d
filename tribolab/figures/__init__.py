"""What each figure shows, as a description that `tribolab.plot` and the page both draw."""
