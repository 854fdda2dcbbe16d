"""Results as netCDF files, and tables checked against their schema."""
