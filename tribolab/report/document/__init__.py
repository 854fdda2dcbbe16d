"""Content of report.json, and the types from which its schema is made."""
