"""The models of a campaign, one beside each measured curve in a fluid."""
