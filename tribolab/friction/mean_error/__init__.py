"""How far the mean of a record whose samples are correlated may be off."""
