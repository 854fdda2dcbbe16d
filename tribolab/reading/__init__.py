"""Bytes of a file become tables, and tables become runs and scans in SI units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.reading.netcdf.netcdf import (
        read_netcdf as read_netcdf,
        write_netcdf as write_netcdf,
    )
    from tribolab.reading.unknown.proposal.draft import draft_dialect as draft_dialect

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
