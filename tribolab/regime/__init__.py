"""Sliding mode of a contact: evidence, verdict, and wording."""
