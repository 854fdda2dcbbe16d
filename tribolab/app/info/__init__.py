"""Output of `tribolab info` on a file of runs or scans."""
