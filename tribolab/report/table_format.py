"""Formats of tables."""

from __future__ import annotations

from tribolab.core.errors import ConfigError, nearest, shown

FORMATS = ("csv", "xlsx", "parquet")


def table_format(name: str) -> str:
    """Return the name of a format; raise an error that lists the formats if it is unknown."""
    if name not in FORMATS:
        raise ConfigError(
            f"--tables {shown(name)}: there is no such format{nearest(name, FORMATS)}",
            cure=f"state {', '.join(FORMATS)}",
        )
    return name
