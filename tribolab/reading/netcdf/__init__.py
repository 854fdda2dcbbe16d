"""Results as netCDF files, and validation of tables against their schema."""
