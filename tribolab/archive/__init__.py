"""Archives of results with raw data and metadata, for a data repository."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.archive.packing import pack as pack

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
