"""Models of a campaign, one for each measured curve in a fluid."""
