"""Basic tools for all subpackages."""
