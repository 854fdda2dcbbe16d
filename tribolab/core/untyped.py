"""Dictionaries that are no records, and may hold anything: only here, and only of these kinds."""

from __future__ import annotations

from typing import Any

# An object of JSON or TOML, or attributes of a dataset, on its way from a file or into one. What it
# holds is proved by its schema, or by the record that it is made from.
Json = dict[str, Any]

# Arguments of a function by their names, collected before it is called: it knows their types.
Arguments = dict[str, Any]
