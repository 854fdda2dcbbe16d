"""What is known of a campaign and where it lies: catalogue, data files, the results folder."""
