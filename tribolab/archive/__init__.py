"""Archives of results with their raw data and metadata, for a repository."""
