"""Sliding mode of a contact: evidence, verdict, and wording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.regime.model import Mode
    from tribolab.regime.several import sliding_modes
    from tribolab.regime.verdict import sliding_mode

__all__ = [
    "Mode",
    "sliding_mode",
    "sliding_modes",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "Mode": "model",
        "sliding_mode": "verdict",
        "sliding_modes": "several",
    },
)
