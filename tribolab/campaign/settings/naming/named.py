"""Check whether a campaign file names a file, even if the file is missing."""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatchcase
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from tribolab.campaign.settings.files import label_of

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign


def is_named(campaign: Campaign, patterns: Iterable[str], label: str) -> bool:
    """Whether the label of a raw file matches one of the campaign's patterns for raw files."""
    raw = PurePosixPath(label_of(campaign, campaign.raw))
    path = PurePosixPath(label)
    if not path.is_relative_to(raw):
        return False
    parts = path.relative_to(raw).parts
    return any(_matches(parts, PurePosixPath(pattern).parts) for pattern in patterns)


def _matches(parts: tuple[str, ...], pattern: tuple[str, ...]) -> bool:
    if not pattern:
        return not parts
    if pattern[0] == "**":
        rest = range(len(parts) + 1)
        return any(_matches(parts[n:], pattern[1:]) for n in rest)
    if not parts or not (parts[0] == pattern[0] or fnmatchcase(parts[0], pattern[0])):
        return False
    return _matches(parts[1:], pattern[1:])
