"""Written results of a campaign: the page report.html, report.json, tables and figures."""
