"""Comparison of results folders, history of instruments, and planning of measurements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.comparison.instrument_history import history as history
    from tribolab.comparison.planning import measuring_plan as measuring_plan
    from tribolab.comparison.repeat_study import repeatability as repeatability

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
