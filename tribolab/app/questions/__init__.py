"""Questions about a file, and the answers typed or stated on the command line."""
