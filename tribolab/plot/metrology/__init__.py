"""Figures of how well a number is known: budgets, repeats, campaigns beside each other."""
