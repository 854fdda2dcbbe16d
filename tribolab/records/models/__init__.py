"""Records of models: fits, budgets and regimes, with their wording."""
