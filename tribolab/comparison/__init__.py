"""Results folders beside each other and over time: compared, followed, planned from."""
