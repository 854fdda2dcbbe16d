"""Reading of scans: profiles and maps of heights."""
