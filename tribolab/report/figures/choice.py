"""Choice of the figures that a report draws; fast to import, as every command needs it."""

from __future__ import annotations

from typing import Literal

from tribolab.core.errors import ConfigError, shown

Wanted = Literal["all", "curves", "none"]


_WANTED: dict[str, Wanted] = {"all": "all", "curves": "curves", "none": "none"}


def wanted(word: str) -> Wanted:
    """Return the choice of figures for an option.

    Raises
    ------
    ConfigError
        If it is not ``"all"``, ``"curves"`` or ``"none"``.
    """
    if word in _WANTED:
        return _WANTED[word]
    raise ConfigError(f"figures: '{shown(word)}' is not all, curves or none")
