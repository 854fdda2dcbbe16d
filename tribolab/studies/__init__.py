"""Parameter sets named after their papers, and comparisons with published numbers."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribolab.studies.comparison import compare_with_paper

__all__ = ["compare_with_paper", "xu2026"]


def __getattr__(name: str) -> Any:
    if name == "compare_with_paper":
        return importlib.import_module("tribolab.studies.comparison").compare_with_paper
    if name == "xu2026":
        return importlib.import_module("tribolab.studies.xu2026")
    raise AttributeError(f"module 'tribolab.studies' has no attribute '{name}'")
