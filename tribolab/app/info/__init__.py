"""What `tribolab info` says of a file of runs or scans."""
