"""Results as others can read them: packed with what they were made of, and described."""
