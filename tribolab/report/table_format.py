"""Formats of the tables in a results folder, next to CSV."""

from __future__ import annotations

from tribolab.core.errors import ConfigError, nearest, shown

FORMATS = ("csv", "xlsx", "parquet")


def table_format(name: str) -> str:
    """Return the name of a table format unchanged; raise if there is no such format."""
    if name not in FORMATS:
        raise ConfigError(
            f"--tables {shown(name)}: there is no such format{nearest(name, FORMATS)}",
            cure=f"state {', '.join(FORMATS)}",
        )
    return name
