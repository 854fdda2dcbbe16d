"""Lexicon: names that files use for quantities and settings, as TOML files, and their lookup."""
