"""Systems measured in published papers: their parameters, and their numbers to compare with."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.studies import xu2026 as xu2026
    from tribolab.studies.comparison import compare_with_paper as compare_with_paper

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
