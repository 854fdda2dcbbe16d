"""The zero of the friction force: where it is known from, and what is in doubt about it."""
