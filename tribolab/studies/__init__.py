"""Parameter sets named after the papers they come from."""
