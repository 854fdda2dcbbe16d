"""Types for dictionaries of unknown content, kept in one place."""

from __future__ import annotations

from typing import Any

# Object of JSON or TOML, or attributes of a dataset, while it is read or written. Its
# content is validated by a schema, or by the record it comes from.
Json = dict[str, Any]

# Keyword arguments collected before a call; the called function checks their types.
Arguments = dict[str, Any]
