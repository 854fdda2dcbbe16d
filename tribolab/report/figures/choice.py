"""Option that selects the figure files of a report, in a module that imports quickly."""

from __future__ import annotations

from typing import Literal

from tribolab.core.errors import ConfigError, shown

Wanted = Literal["all", "curves", "none"]
_WANTED: dict[str, Wanted] = {"all": "all", "curves": "curves", "none": "none"}


def wanted(word: str) -> Wanted:
    """Return the value of the option `figures` after checking it.

    Raises
    ------
    ConfigError
        If it is not ``"all"``, ``"curves"`` or ``"none"``.
    """
    if word in _WANTED:
        return _WANTED[word]
    raise ConfigError(f"figures: '{shown(word)}' is not all, curves or none")
