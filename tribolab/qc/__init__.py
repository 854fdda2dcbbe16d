"""Quality of instrument data: flags, checks on runs and scans, findings."""
