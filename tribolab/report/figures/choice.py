"""Which figures a report draws: light to import, as every command asks it."""

from __future__ import annotations

from typing import Literal

from tribolab.core.errors import ConfigError, shown

Wanted = Literal["all", "curves", "none"]


_WANTED: dict[str, Wanted] = {"all": "all", "curves": "curves", "none": "none"}


def wanted(word: str) -> Wanted:
    """Return which figures are meant.

    Raises
    ------
    ConfigError
        If the word is none of ``"all"``, ``"curves"``, ``"none"``.
    """
    if word in _WANTED:
        return _WANTED[word]
    raise ConfigError(f"figures: '{shown(word)}' is not all, curves or none")
