"""The formats of tables that may be asked for."""

from __future__ import annotations

from tribolab.core.errors import ConfigError, nearest, shown

FORMATS = ("csv", "xlsx", "parquet")


def table_format(name: str) -> str:
    """Return the name of a format; an error names those that exist."""
    if name not in FORMATS:
        raise ConfigError(
            f"--tables {shown(name)}: there is no such format{nearest(name, FORMATS)}",
            cure=f"state {', '.join(FORMATS)}",
        )
    return name
