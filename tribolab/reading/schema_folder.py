"""Location of the folder raw_data_schema: next to the package, or inside it in a wheel."""

from __future__ import annotations

from pathlib import Path

from tribolab.core.errors import ConfigError


def schema_folder() -> Path:
    """Return the folder ``raw_data_schema``, wherever tribolab was installed from.

    Raises
    ------
    ConfigError
        If the installation is incomplete.

    Examples
    --------
    >>> (schema_folder() / "instruments").is_dir()
    True
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "raw_data_schema", package.parent / "raw_data_schema"):
        if (folder / "instruments").is_dir():
            return folder
    raise ConfigError(
        f"{package}: the folder raw_data_schema is missing from this installation; reinstall"
    )
