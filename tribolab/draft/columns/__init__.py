"""What the columns of an unknown table hold, and what follows from them."""
