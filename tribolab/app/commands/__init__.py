"""Commands with their help texts, options and exit codes."""
