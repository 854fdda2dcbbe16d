"""The runs of a campaign: analysed, checked, written and recorded."""
