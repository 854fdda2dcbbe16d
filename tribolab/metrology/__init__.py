"""Uncertainty of results: budgets, repeatability, control charts, comparisons, planning."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.metrology.budget import uncertainty_budget as uncertainty_budget
    from tribolab.metrology.dead_weight import dead_weight_gain as dead_weight_gain

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
