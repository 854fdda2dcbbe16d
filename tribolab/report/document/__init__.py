"""Types and content of report.json."""
