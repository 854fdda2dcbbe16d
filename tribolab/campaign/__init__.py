"""Campaigns: files of settings, and the stages over runs, curves, surfaces and models."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.campaign.settings.load import load_campaign as load_campaign
    from tribolab.campaign.settings.review import load_review as load_review

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
