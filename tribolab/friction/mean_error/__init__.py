"""Standard error of the mean of a record with correlated samples."""
