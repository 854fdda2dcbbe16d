"""The report page, report.json and the tables."""
