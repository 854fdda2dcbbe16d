"""report.json: its types, and what fills them."""
