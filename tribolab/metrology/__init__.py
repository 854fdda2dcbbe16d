"""How well a number is known: budget, repeatability, control charts, comparison, planning."""
