"""What each column of an unknown table holds, and in which unit."""
