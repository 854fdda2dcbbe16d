"""Sliding mode of a contact: evidence, verdict and wording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.regime.model import Mode as Mode
    from tribolab.regime.several import sliding_modes as sliding_modes
    from tribolab.regime.verdict import sliding_mode as sliding_mode

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
