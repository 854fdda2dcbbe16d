"""Bytes of a file become tables, and tables become runs and scans in SI units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
    from tribolab.reading.unknown.proposal.draft import draft_dialect

__all__ = [
    "draft_dialect",
    "read_netcdf",
    "write_netcdf",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "draft_dialect": "unknown.proposal.draft",
        "read_netcdf": "netcdf.netcdf",
        "write_netcdf": "netcdf.netcdf",
    },
)
