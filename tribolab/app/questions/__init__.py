"""Questions about a file, and answers typed or stated on the command line."""
