"""The figures that the page itself draws: what they show, as data."""
