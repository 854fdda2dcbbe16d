"""What each column of an unknown table holds, in which unit."""
