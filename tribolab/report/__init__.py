"""What a campaign leaves behind: the page report.html, report.json and the tables."""
