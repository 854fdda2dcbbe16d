"""Types for dictionaries with unknown contents."""

from __future__ import annotations

from typing import Any

# Object from JSON or TOML, or attributes of a dataset, while they are read or written. The
# contents are validated by a schema, or by the record from which they are made.
Json = dict[str, Any]

# Keyword arguments collected before a call; the called function checks their types.
Arguments = dict[str, Any]
