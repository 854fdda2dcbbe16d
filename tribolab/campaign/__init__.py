"""Campaigns: files of settings, and the stages over runs, curves, surfaces and models."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.campaign.settings.load import load_campaign
    from tribolab.campaign.settings.review import load_review

__all__ = [
    "load_campaign",
    "load_review",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "load_campaign": "settings.load",
        "load_review": "settings.review",
    },
)
