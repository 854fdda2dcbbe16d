"""Names of runs and files in a campaign, and the labels in them."""
