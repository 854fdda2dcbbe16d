"""What a model leaves: fits, budgets, regimes, and the words for them."""
