"""Storage of a campaign's results: catalogue, data files and results folder."""
