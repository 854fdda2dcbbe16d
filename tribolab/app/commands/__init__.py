"""The commands: their words, options and exit codes. What they do lies beside them."""
