"""Files to xarray: dialects, runs, scans, netCDF."""
